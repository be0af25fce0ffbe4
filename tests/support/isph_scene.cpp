#include "support/isph_scene.hpp"

#include "treacle/core/pseudo_random.hpp"
#include "treacle/search/particle_sort.hpp"

namespace treacle::test {

template <int D>
IsphScene<D>::IsphScene(const Case& theCase, Particles<D> state)
    : c(theCase), particles(std::move(state)), pairs(makeIsphPairs<D>(c)) {
  sortByCell(context, pairs.grid, particles, ranges, workspace);
  placeSorted(particles, ranges, pairs);
  pairs.body = particles.body.data();
  pairs.fluidOfFluid = find(RowKind::FluidOfFluid, fluidOfFluid);
  pairs.wallsOfFluid = find(RowKind::WallsOfFluid, wallsOfFluid);
  pairs.fluidOfWalls = find(RowKind::FluidOfWalls, fluidOfWalls);
  pairs.fluidEntries = fluidOfFluid.column.size();
  density.resize(n());
  deficit.resize(n());
  surface.resize(n());
  renormalisation.resize(n());
  missing.resize(n());
  pairs.renormalisation = pairs.acrossWalls = renormalisation.data();
  if (pairs.accurate && !particles.wallSurface.empty()) {
    acrossWalls.resize(n());
    pairs.acrossWalls = acrossWalls.data();
    pairs.wallSurface = particles.wallSurface.data();
  }
  pairs.missing = missing.data();
  sumOnFluid(context, pairs, DensityTerm<D>{density.data(), deficit.data(), surface.data()});
  findAcrossWalls();
}

template <int D>
NeighbourRowsView IsphScene<D>::find(RowKind kind, NeighbourRows<>& rows) {
  const double radius = pairs.kernel.radius();
  findNeighbours<D>(context, pairs, {0.79 * radius, radius}, kind, rows);
  return rows.view();
}

template <int D>
Particles<D> particlesAt(const std::vector<Vec<D>>& fluid, const std::vector<Vec<D>>& wall) {
  Particles<D> p;
  p.resize(static_cast<std::uint32_t>(fluid.size()), static_cast<std::uint32_t>(wall.size()));
  p.forEachField([](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); });
  std::copy(wall.begin(), wall.end(), std::copy(fluid.begin(), fluid.end(), p.position.begin()));
  for (std::uint32_t i = 0; i < p.count; ++i) p.id[i] = i;
  return p;
}

template <int D>
std::vector<Vec<D>> latticeAt(const Vec<D>& first, const Vec<D, int>& count, double l) {
  std::vector<Vec<D>> points;
  std::size_t total = 1;
  for (int k = 0; k < D; ++k) total *= count[k];
  for (std::size_t n = 0; n < total; ++n) {
    Vec<D> x = first;
    std::size_t rest = n;
    for (int k = 0; k < D; rest /= count[k], ++k) x[k] += l * static_cast<double>(rest % count[k]);
    points.push_back(x);
  }
  return points;
}

Case waterCase(int dimensions, const Vec<3>& size) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 0.01;
  c.time = {1e-3, 1};
  for (int k = 0; k < dimensions; ++k) c.domain.max[k] = size[k] * c.spacing;
  c.materials.push_back({"water", 1000, 1e-3, 0, 0});
  c.method.kind = MethodKind::Isph;
  c.solver.preconditioner = PreconditionerKind::HatMultigrid;
  c.solver.firstGuess = FirstGuess::Last;
  return c;
}

template <int D>
IsphScene<D> makeIsphScene(Walls walls, double jitter, unsigned seed) {
  Scene<D> s = makeScene<D>({.walls = walls, .seed = seed, .jitter = jitter});
  s.c.method.kind = MethodKind::Isph;
  s.c.gravity = D == 2 ? Vec<3>{1.5, -9} : Vec<3>{1.5, -0.5, -9};
  Particles<D>& p = s.particles;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    for (int k = 0; k < D; ++k) p.velocity[i][k] = pseudoRandom(D * i + k);
    p.body[i] = static_cast<std::uint8_t>(i % 2);
  }
  return {s.c, std::move(p)};
}

template <int D>
void giveSurfaces(const Case& c, Particles<D>& particles) {
  const double l = c.spacing;
  particles.wallSurface.resize(particles.wallCount());
  const std::vector<double> x = randomNumbers(2 * D * particles.wallCount(), 11);
  for (std::size_t k = 0, n = 0; k < particles.wallCount(); ++k) {
    WallSurface<D>& surface = particles.wallSurface[k] = {};
    for (int a = 0; a < D; ++a) surface.face[0][a] = static_cast<float>(0.2 * l * x[n++]);
    for (int a = 0; a < D; ++a) surface.face[1][a] = static_cast<float>(k % 3 == 0 ? 0.2 * l * x[n++] : 0);
    surface.face[0][D - 1] += static_cast<float>(0.8 * l);
    if (k % 3 == 0) surface.face[1][0] += static_cast<float>(0.7 * l);
  }
}

template <int D>
IsphScene<D> makeLargeIsphScene() {
  Case c = sceneCase(D);
  c.method.kind = MethodKind::Isph;
  c.gravity[D - 1] = -9;
  const double l = c.spacing, size = (D == 2 ? 170 : 32) * l;
  for (int k = 0; k < D; ++k) c.domain.max[k] = size;
  return {c, jitteredLattice<D>(
                 c, 0.1, 3, [&](const Vec<D>& x) { return x[D - 1] >= 4 * l && x[D - 1] < size - 6 * l; },
                 [&](const Vec<D>& x) { return x[D - 1] < 4 * l; })};
}

std::vector<double> randomNumbers(std::size_t n, unsigned seed) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = pseudoRandom(static_cast<std::uint32_t>(i + 1000003u * seed));
  return x;
}

template <int D>
std::vector<Vec<D>> randomVelocities(std::size_t n, unsigned seed) {
  const std::vector<double> x = randomNumbers(D * n, seed);
  std::vector<Vec<D>> v(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < D; ++k) v[i][k] = x[D * i + k];
  return v;
}

template <class T>
Matrix dense(const IsphMatrix<T>& a) {
  Matrix m = Matrix::Zero(a.rows, a.rows);
  for (std::uint32_t i = 0; i < a.rows; ++i) {
    m(i, i) = a.diagonal[i];
    for (const std::uint32_t section : {i, a.rows + i})
      for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
        m(i, a.column[k]) -= a.coefficient[k];
  }
  return m;
}

template struct IsphScene<2>;
template <int D>
IsphScene<D> makeRegions(unsigned seed) {
  constexpr int block = 4, blocks = D == 2 ? 20 : 8;  // wider than the kernel's radius [spacings]
  Case c = waterCase(D, Vec<3>::filled(block * blocks));
  c.domain.periodic[0] = true;
  Vec<D, int> count = Vec<D, int>::filled(block), all = Vec<D, int>::filled(blocks);
  const auto places = latticeAt<D>(Vec<D>::filled(0.5 * c.spacing), all, block * c.spacing);
  const std::vector<double> chance = randomNumbers(places.size(), seed);
  std::vector<Vec<D>> points;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (chance[k] < (D == 2 ? -0.35 : -0.8))
      for (const Vec<D>& x : latticeAt<D>(places[k], count, c.spacing)) points.push_back(x);
  const auto shifts = randomVelocities<D>(points.size(), seed + 1);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += (0.1 * c.spacing) * shifts[i];
  IsphScene<D> s(c, particlesAt<D>(points));
  const std::vector<double> isSurface = randomNumbers(points.size(), seed + 2);
  for (std::size_t i = 0; i < points.size(); ++i) s.surface[i] = isSurface[i] > 0.99 ? Place::Surface : 0;
  return s;
}

template Particles<2> particlesAt(const std::vector<Vec<2>>&, const std::vector<Vec<2>>&);
template std::vector<Vec<2>> latticeAt(const Vec<2>&, const Vec<2, int>&, double);
template IsphScene<2> makeIsphScene(Walls, double, unsigned);
template void giveSurfaces(const Case&, Particles<2>&);
template IsphScene<2> makeLargeIsphScene();
template IsphScene<2> makeRegions(unsigned);
template std::vector<Vec<2>> randomVelocities(std::size_t, unsigned);
template struct IsphScene<3>;
template Particles<3> particlesAt(const std::vector<Vec<3>>&, const std::vector<Vec<3>>&);
template std::vector<Vec<3>> latticeAt(const Vec<3>&, const Vec<3, int>&, double);
template IsphScene<3> makeIsphScene(Walls, double, unsigned);
template void giveSurfaces(const Case&, Particles<3>&);
template IsphScene<3> makeLargeIsphScene();
template IsphScene<3> makeRegions(unsigned);
template std::vector<Vec<3>> randomVelocities(std::size_t, unsigned);
template Matrix dense(const IsphMatrix<double>&);
template Matrix dense(const IsphMatrix<float>&);

}  // namespace treacle::test
