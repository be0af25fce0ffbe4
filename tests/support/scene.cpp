#include "support/scene.hpp"

#include "treacle/model/case/case_keys.hpp"
#include "treacle/mph/renormalisation.hpp"
#include "treacle/mph/viscosity_scale.hpp"
#include "treacle/mph/wall_surfaces.hpp"

#include <cmath>
#include <random>

namespace treacle::test {

Case sceneCase(int dimensions, bool twoMaterials, SchemeKind scheme) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1e-3;
  c.time = {1e-3, 1};
  c.method = defaultMethod(scheme);
  const double size = dimensions == 2 || scheme == SchemeKind::Accurate ? 20e-3 : 14e-3;  // three search cells
  for (int k = 0; k < dimensions; ++k) {
    c.domain.max[k] = size;
    c.domain.periodic[k] = true;
  }
  c.materials.push_back({"honey", 1.4e3, 10, 1e4, 1e6});
  c.materials.push_back(twoMaterials ? Material{"resin", 1.1e3, 2.5, 4e3, 5e5, 4e-4} : c.materials[0]);
  return c;
}

template <int D>
Particles<D> jitteredLattice(const Case& c, double jitter, unsigned seed, const Where<D>& inFluid,
                             const Where<D>& inWall) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-jitter, jitter);
  std::vector<Vec<D>> fluid, wall;
  const int points = static_cast<int>(std::lround((c.domain.max[0] - c.domain.min[0]) / c.spacing));
  Vec<D, int> cell{};
  while (true) {
    Vec<D> x{};
    for (int k = 0; k < D; ++k) x[k] = c.domain.min[k] + (cell[k] + 0.5 + offset(random)) * c.spacing;
    if (inFluid(x))
      fluid.push_back(x);
    else if (inWall(x))
      wall.push_back(x);
    int k = 0;
    while (k < D && ++cell[k] == points) cell[k++] = 0;
    if (k == D) break;
  }
  Particles<D> p;
  p.resize(static_cast<std::uint32_t>(fluid.size()), static_cast<std::uint32_t>(wall.size()));
  for (std::uint32_t i = 0; i < p.count; ++i) {
    p.position[i] = i < p.fluidCount ? fluid[i] : wall[i - p.fluidCount];
    for (int k = 0; k < D; ++k) p.velocity[i][k] = i < p.fluidCount ? offset(random) : 0;
    p.pressure[i] = p.numberDensity[i] = 0;
    p.material[i] = static_cast<std::uint8_t>(p.position[i][0] > 0.4 * c.domain.max[0]);
    p.body[i] = 0;
    p.id[i] = i;
  }
  return p;
}

template <int D>
void knowSurface(const Case& c, double height, Particles<D>& p) {
  if (!c.isAccurate()) return;
  p.wallSurface.resize(p.wallCount());
  for (std::uint32_t k = 0; k < p.wallCount(); ++k) {
    WallSurface<D>& surface = p.wallSurface[k] = {};
    surface.face[0][D - 1] = static_cast<float>(height - p.position[p.fluidCount + k][D - 1]);
    if (k % 3 == 0) surface.face[1][0] = static_cast<float>((k % 2 ? -0.7 : 0.7) * c.spacing);
  }
}

template <int D>
void prepare(Scene<D>& s) {
  s.neighbourhood = std::make_unique<MphNeighbourhood<D>>(s.c);
  s.neighbourhood->sort(s.context, s.particles);
  s.neighbourhood->buildLists(s.context, s.particles);
  if (!s.particles.wallSurface.empty()) {
    const std::uint32_t n = s.n(), walls = s.pairs().activeCount - n;
    s.wallSurface.resize(walls);
    placeSurfaces<D>(s.context, {s.particles.wallSurface.span(), {}}, s.particles.body.span().subspan(n, walls),
                     s.wallSurface.span());
    s.neighbourhood->setWallSurfaces(s.wallSurface);
  }
  if (s.c.isAccurate()) {
    s.renormalisation.resize(s.n());
    renormalisation<D>(s.context, s.pairs(), s.renormalisation.span());
    s.neighbourhood->setRenormalisation(s.renormalisation);
  }
  if (const double correction = s.c.method.viscosityCorrection; correction > 0) {
    s.viscosityScale.resize(s.n());
    viscosityScale<D>(s.context, s.pairs(), correction, s.viscosityScale.span());
    s.neighbourhood->setViscosityScale(s.viscosityScale);
  }
  if (s.c.keepsVolume()) {  // as gaps here and there would have it
    s.wallShare.resize(s.pairs().activeCount);
    for (std::uint32_t i = 0; i < s.wallShare.size(); ++i)
      s.wallShare[i] = i < s.n() ? 1 : std::exp(-0.6 * (i % 7));
    s.neighbourhood->setWallShares(s.wallShare);
  }
  s.wallBlock.resize(s.n());
  s.wallGradient.resize(s.n());
  wallTerms<D>(s.context, s.pairs(), s.terms());
}

template <int D>
Scene<D> makeScene(const SceneOptions& options) {
  Scene<D> s;
  s.c = sceneCase(D, options.twoMaterials, options.scheme);
  if (!options.slips) s.c.materials[1].slipLength = 0;
  // Off-centre, so that fluid and walls cross periodic ends and many cells are empty.
  const double l = s.c.spacing, height = D == 2 ? 8 * l : 5 * l, floor = 4 * l;
  const auto inWall = [&](const Vec<D>& x) { return options.walls == Walls::Floor && x[D - 1] < floor; };
  const auto inFluid = [&](const Vec<D>& x) {
    const bool across = x[0] < 5 * l || x[0] > s.c.domain.max[0] - 3 * l;
    return !inWall(x) && across && x[D - 1] >= floor && x[D - 1] < floor + height && (D == 2 || x[1] < 6 * l);
  };
  s.particles = jitteredLattice<D>(s.c, options.jitter, options.seed, inFluid, inWall);
  knowSurface(s.c, floor, s.particles);
  prepare(s);
  return s;
}

template Particles<2> jitteredLattice(const Case&, double, unsigned, const Where<2>&, const Where<2>&);
template void knowSurface(const Case&, double, Particles<2>&);
template void prepare(Scene<2>&);
template Scene<2> makeScene(const SceneOptions&);
template Particles<3> jitteredLattice(const Case&, double, unsigned, const Where<3>&, const Where<3>&);
template void knowSurface(const Case&, double, Particles<3>&);
template void prepare(Scene<3>&);
template Scene<3> makeScene(const SceneOptions&);

}  // namespace treacle::test
