#pragma once

#include "support/scene.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "treacle/linear/lanczos_scalars.hpp"

#include <algorithm>
#include <vector>

namespace treacle::test {

/// Particles of ISPH after the sort, with their neighbours, densities and free surface.
template <int D>
struct IsphScene {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  IsphPairs<D> pairs;  // looks at the members around it
  CellRanges<> ranges;
  SortWorkspace<> workspace;
  NeighbourRows<> fluidOfFluid, wallsOfFluid, fluidOfWalls;
  Buffer<double> density;
  Buffer<Vec<D>> deficit;
  Buffer<std::uint8_t> surface;

  IsphScene(const Case& theCase, Particles<D> state)
      : c(theCase), particles(std::move(state)), pairs(makeIsphPairs<D>(c)) {
    sortByCell(context, pairs.grid, particles, ranges, workspace);
    pairs.fluidCount = particles.fluidCount;
    pairs.activeCount = ranges.activeCount;
    pairs.position = particles.position;
    pairs.material = particles.material;
    pairs.body = particles.body.data();
    pairs.cells = viewOf(ranges);
    pairs.fluidOfFluid = find(RowKind::FluidOfFluid, fluidOfFluid);
    pairs.wallsOfFluid = find(RowKind::WallsOfFluid, wallsOfFluid);
    pairs.fluidOfWalls = find(RowKind::FluidOfWalls, fluidOfWalls);
    pairs.fluidEntries = fluidOfFluid.column.size();
    density.resize(n());
    deficit.resize(n());
    surface.resize(n());
    sumOnFluid(context, pairs, DensityTerm<D>{density.data(), deficit.data(), surface.data()});
  }

  std::uint32_t n() const { return particles.fluidCount; }
  std::uint32_t surfaceCount() const {
    return static_cast<std::uint32_t>(std::count(surface.begin(), surface.end(), 1));
  }

 private:
  NeighbourRowsView find(RowKind kind, NeighbourRows<>& rows) {
    const double radius = pairs.kernel.radius();
    findNeighbours<D>(context, pairs.grid, pairs.cells, pairs.position, pairs.fluidCount, pairs.activeCount,
                      {0.79 * radius, radius}, kind, rows);
    return rows.view();
  }
};

/// At rest, of the first material and body.
template <int D>
Particles<D> particlesAt(const std::vector<Vec<D>>& fluid, const std::vector<Vec<D>>& wall = {}) {
  Particles<D> p;
  p.resize(static_cast<std::uint32_t>(fluid.size()), static_cast<std::uint32_t>(wall.size()));
  p.forEachField([](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); });
  std::copy(wall.begin(), wall.end(), std::copy(fluid.begin(), fluid.end(), p.position.begin()));
  for (std::uint32_t i = 0; i < p.count; ++i) p.id[i] = i;
  return p;
}

/// The points of a lattice of spacing l with one at `first`; the first axis runs fastest.
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

/// Water with a spacing of 1 cm in an open domain of `size` spacings from the origin on.
inline Case waterCase(int dimensions, const Vec<3>& size) {
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

/// A jittered body of two fluids of unequal density and viscosity, moving at random, on a floor that moves, too
/// (or without it); it lies across periodic ends.
template <int D>
IsphScene<D> makeIsphScene(Walls walls = Walls::Floor, double jitter = 0.1, unsigned seed = 1) {
  Scene<D> s = makeScene<D>(walls, seed, jitter);
  s.c.method.kind = MethodKind::Isph;
  s.c.gravity = D == 2 ? Vec<3>{1.5, -9} : Vec<3>{1.5, -0.5, -9};
  Particles<D>& p = s.particles;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    for (int k = 0; k < D; ++k) p.velocity[i][k] = pseudoRandom(D * i + k);
    p.body[i] = static_cast<std::uint8_t>(i % 2);
  }
  return {s.c, std::move(p)};
}

/// More than enough fluid for every way in which kernels share work, on a floor, free of symmetries.
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

/// Random numbers in (-1, 1), the same for the same seed.
inline std::vector<double> randomNumbers(std::size_t n, unsigned seed) {
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

/// A matrix of pairs and what it is made of, not packed.
template <int D, class T>
struct IsphTestSystem {
  Buffer<T> coefficient, inverseNear;
  Buffer<double> diagonal;
  Buffer<IsphMoments<D>> moments;
  IsphMatrix<T> a;

  template <class Row>
  IsphTestSystem(IsphScene<D>& s, const Row& row)
      : coefficient(s.pairs.fluidEntries), inverseNear(s.n()), diagonal(s.n()), moments(s.n()) {
    IsphMatrixParts<D, T> parts{};
    parts.coefficient = coefficient;
    parts.unit = row.largest(s.pairs) / 255;
    parts.diagonal = diagonal;
    parts.inverseNear = inverseNear;
    parts.moments = moments;
    fillIsphMatrix(s.context, s.pairs, row, parts);
    a.rows = s.n();
    a.start = s.pairs.fluidOfFluid.start;
    a.column = s.pairs.fluidOfFluid.column;
    a.coefficient = coefficient.data();
    a.unit = parts.unit;
    a.diagonal = diagonal.data();
    a.inverseNear = inverseNear.data();
  }
  IsphTestSystem(const IsphTestSystem&) = delete;
};

template <class T>
Eigen::MatrixXd dense(const IsphMatrix<T>& a) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(a.rows, a.rows);
  for (std::uint32_t i = 0; i < a.rows; ++i) {
    m(i, i) = a.diagonal[i];
    for (const std::uint32_t section : {i, a.rows + i})
      for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
        m(i, a.column[k]) -= a.coefficient[k];
  }
  return m;
}

}  // namespace treacle::test
