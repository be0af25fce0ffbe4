#pragma once

#include "treacle/model/case.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/search/buckets.hpp"

#include <Eigen/Dense>

#include <memory>
#include <random>
#include <vector>

namespace treacle::test {

/// A small body of fluid on a floor in a periodic domain, jittered, with two materials: everything that a step
/// prepares before its solve, and the same state for oracles that know only positions and constants.
template <int D>
struct Scene {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  std::unique_ptr<MphNeighbourhood<D>> neighbourhood;
  Buffer<Block<D>> wallBlock;
  Buffer<Vec<D>> wallGradient;

  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }
  double volume() const { return std::pow(c.spacing, D); }
  const MphPairs<D>& pairs() const { return neighbourhood->pairs(); }
  const CellRanges<>& ranges() const { return neighbourhood->ranges(); }
  std::uint32_t n() const { return pairs().fluidCount; }
  Eigen::Index unknowns() const { return Eigen::Index{D} * n(); }
};

inline Case sceneCase(int dimensions, bool twoMaterials = true) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1e-3;
  c.time = {1e-3, 1};
  const double size = dimensions == 2 ? 20e-3 : 14e-3;
  for (int k = 0; k < dimensions; ++k) {
    c.domain.max[k] = size;
    c.domain.periodic[k] = true;
  }
  c.materials.push_back({"honey", 1.4e3, 10, 1e4, 1e6});
  c.materials.push_back(twoMaterials ? Material{"resin", 1.1e3, 2.5, 4e3, 5e5} : c.materials[0]);
  return c;
}

/// Fluid and wall particles at jittered lattice points; fluid where inFluid(x), wall where inWall(x) says so.
template <int D, class InFluid, class InWall>
Particles<D> jitteredLattice(const Case& c, double jitter, unsigned seed, InFluid&& inFluid, InWall&& inWall) {
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

/// Brings particles into the state of a step before its solve.
template <int D>
void prepare(Scene<D>& s) {
  s.neighbourhood = std::make_unique<MphNeighbourhood<D>>(s.c);
  s.neighbourhood->sort(s.context, s.particles);
  s.neighbourhood->buildLists(s.context, s.particles);
  s.wallBlock.resize(s.n());
  s.wallGradient.resize(s.n());
  wallTerms<D>(s.context, s.pairs(), s.terms());
}

enum class Walls { Floor, None };

template <int D>
Scene<D> makeScene(Walls walls = Walls::Floor, unsigned seed = 1, double jitter = 0.2, bool twoMaterials = true) {
  Scene<D> s;
  s.c = sceneCase(D, twoMaterials);
  // Off-centre, so that fluid and walls cross periodic ends and many cells are empty.
  const double l = s.c.spacing, height = D == 2 ? 8 * l : 5 * l, floor = 4 * l;
  const auto inWall = [&](const Vec<D>& x) { return walls == Walls::Floor && x[D - 1] < floor; };
  const auto inFluid = [&](const Vec<D>& x) {
    const bool across = x[0] < 5 * l || x[0] > s.c.domain.max[0] - 3 * l;
    return !inWall(x) && across && x[D - 1] >= floor && x[D - 1] < floor + height && (D == 2 || x[1] < 6 * l);
  };
  s.particles = jitteredLattice<D>(s.c, jitter, seed, inFluid, inWall);
  prepare(s);
  return s;
}

/// Eigen's view of one vector per particle.
template <int D>
Eigen::VectorXd flat(std::span<const Vec<D>> v) {
  return Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(v.data()), Eigen::Index{D} * v.size());
}
template <int D>
std::vector<Vec<D>> unflat(const Eigen::VectorXd& v) {
  std::vector<Vec<D>> r(v.size() / D);
  for (Eigen::Index i = 0; i < v.size(); ++i) r[i / D][i % D] = v[i];
  return r;
}

inline Eigen::VectorXd randomVector(Eigen::Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(n);
  for (double& x : v) x = normal(random);
  return v;
}

template <int D>
Eigen::MatrixXd dense(const BlockCsr<D>& a) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(D * a.rows(), D * a.rows());
  for (std::uint32_t i = 0; i < a.rows(); ++i)
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k)
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) m(D * i + r, D * a.column[k] + c) += a.value[k](r, c);
  return m;
}

/// Dense matrix of a linear map by its action on the unit vectors.
template <class F>
Eigen::MatrixXd denseOf(Eigen::Index n, F&& map) {
  Eigen::MatrixXd m(n, n);
  for (Eigen::Index j = 0; j < n; ++j) m.col(j) = map(Eigen::VectorXd(Eigen::VectorXd::Unit(n, j)));
  return m;
}

}  // namespace treacle::test
