#include "treacle/search/decomposition.hpp"

#include "mpi/job.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace treacle::test {
namespace {

constexpr std::uint32_t modes = 2;

/// What the fields of a particle hold that it takes along, by which it is known again.
double mark(std::uint32_t id, int field) { return 1000.0 * field + std::sqrt(1.0 + id); }

/// Particles that move, the same at all processes, and the part of them that is this one's. Walls rest.
template <int D>
struct Flow {
  CellGrid<D> grid;
  std::vector<Vec<D>> position;  // of all fluid, by id
  std::uint32_t wallCount;
  Context<Cpu> context;
  Decomposition<D> decomposition;
  Particles<D> particles;
  CellRanges<> ranges;
  SortWorkspace<> workspace;

  Flow(bool periodic, std::uint32_t fluid, std::uint32_t walls, double radius = 1) : wallCount(walls) {
    Vec<D> lo{}, hi{};
    Vec<D, bool> ends{};
    for (int k = 0; k < D; ++k) hi[k] = k == 0 ? 8 : 5.5, ends[k] = periodic;
    grid = CellGrid<D>::make(lo, hi, ends, radius);
    context.communicator = &job();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    particles.resize(fluid, walls, modes);
    for (std::uint32_t i = 0; i < particles.count; ++i) {
      for (int k = 0; k < D; ++k) particles.position[i][k] = uniform(random) * hi[k];
      if (i < fluid) position.push_back(particles.position[i]);
      particles.id[i] = i;
      particles.material[i] = static_cast<std::uint8_t>(i % 3);
      particles.body[i] = static_cast<std::uint8_t>(i % 5);
      particles.pressure[i] = mark(i, 1);
      particles.numberDensity[i] = mark(i, 2);
      particles.velocity[i][0] = mark(i, 3);
    }
    for (std::uint32_t i = 0; i < fluid; ++i) {
      particles.acceleration[i][0] = mark(i, 4);
      particles.jerk[i][0] = mark(i, 5);
      for (std::uint32_t m = 0; m < modes; ++m)
        particles.modes.vectors[m * fluid + i][0] = static_cast<float>(mark(i, 6 + m));
    }
  }

  void sort() { decomposition.sort(context, grid, particles, ranges, workspace); }

  /// Moves everything, then what this process owns.
  template <class F>
  void move(F&& to) {
    for (Vec<D>& x : position) {
      x = to(x);
      ASSERT_TRUE(grid.wrap(x));
    }
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i) particles.position[i] = position[particles.id[i]];
  }

  std::size_t cellOf(const Vec<D>& x) const { return grid.linear(grid.cellOf(x)); }
  bool isOwn(std::size_t cell) const { return decomposition.owners().owner(cell) == job().rank(); }

  /// Every particle is somebody's, once; own ones stand in own cells, with what they brought along.
  void checkOwn() const {
    const Particles<D>& p = particles;
    std::vector<std::uint32_t> owners(position.size());
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const std::uint32_t id = p.id[i];
      ++owners[id];
      EXPECT_TRUE(isOwn(cellOf(p.position[i])));
      EXPECT_EQ(p.position[i], position[id]);
      EXPECT_EQ(p.pressure[i], mark(id, 1));
      EXPECT_EQ(p.numberDensity[i], mark(id, 2));
      EXPECT_EQ(p.velocity[i][0], mark(id, 3));
      EXPECT_EQ(p.acceleration[i][0], mark(id, 4));
      EXPECT_EQ(p.jerk[i][0], mark(id, 5));
      EXPECT_EQ(p.material[i], id % 3);
      EXPECT_EQ(p.body[i], id % 5);
      for (std::uint32_t m = 0; m < p.modeCount(); ++m)
        EXPECT_EQ(p.modes.vectors[m * p.fluidCount + i][0], static_cast<float>(mark(id, 6 + m)));
    }
    job().sum(std::span(owners));
    for (std::uint32_t count : owners) ASSERT_EQ(count, 1u);
  }

  /// The cells around own ones are full: all fluid there is known, from owners in the order of ranks.
  void checkGhosts() {
    const Particles<D>& p = particles;
    std::map<std::size_t, std::uint32_t> held, expected;  // per cell
    for (std::uint32_t i = 0; i < p.wallBegin(); ++i) ++held[cellOf(p.position[i])];
    for (const Vec<D>& x : position) {
      bool near = false;
      forEachAdjacentCell(grid, grid.cellOf(x),
                          [&](const Vec<D, int>& c) { near = near || isOwn(grid.linear(c)); });
      if (near) ++expected[cellOf(x)];
    }
    EXPECT_EQ(held, expected);
    for (const auto& [cell, count] : held) EXPECT_EQ(ranges.fluidEnd[cell] - ranges.fluidBegin[cell], count);
    // Identifiers by exchange: of fluid and of walls, which stand where the ghosts' positions do.
    std::vector<std::uint32_t> id(p.id.begin(), p.id.end());
    const std::uint32_t ownWalls = ranges.activeCount - ranges.ghostWalls;
    std::fill(id.begin() + p.fluidCount, id.begin() + p.wallBegin(), ~0u);
    std::fill(id.begin() + ownWalls, id.begin() + ranges.activeCount, ~0u);
    fillGhosts(context, Held::Active, id.data());
    for (std::uint32_t i = p.fluidCount; i < p.wallBegin(); ++i) {
      ASSERT_LT(id[i], position.size());
      EXPECT_EQ(p.position[i], position[id[i]]);
      EXPECT_EQ(p.material[i], id[i] % 3);
      EXPECT_TRUE(context.halo->isGhost(i));
    }
    for (std::uint32_t i = ownWalls; i < ranges.activeCount; ++i) EXPECT_EQ(id[i], p.id[i]);
  }

  /// All walls are there, and those with fluid in their own or an adjacent cell are somebody's, once.
  void checkWalls() const {
    const Particles<D>& p = particles;
    EXPECT_EQ(p.wallCount(), wallCount);
    std::vector<std::uint8_t> nearFluid(grid.cellCount());
    for (const Vec<D>& x : position)
      forEachAdjacentCell(grid, grid.cellOf(x), [&](const Vec<D, int>& c) { nearFluid[grid.linear(c)] = 1; });
    std::vector<std::uint32_t> owners(p.wallCount()), expected(p.wallCount());
    for (std::uint32_t i = p.wallBegin(); i < p.count; ++i) {
      const std::size_t k = p.id[i] - position.size(), cell = cellOf(p.position[i]);
      EXPECT_EQ(p.pressure[i], mark(p.id[i], 1));
      expected[k] = nearFluid[cell];
      if (i >= ranges.activeCount - ranges.ghostWalls) continue;
      ++owners[k];
      EXPECT_TRUE(isOwn(cell));
    }
    job().sum(std::span(owners));
    EXPECT_EQ(owners, expected);
  }

  /// Indices over all processes count every own particle once.
  void checkIndices() {
    std::vector<std::uint32_t> seen(position.size() + wallCount);
    std::uint64_t walls = context.halo->ownWalls;
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i) ++seen[context.halo->indexOfAll(i)];
    for (std::uint32_t k = 0; k < walls; ++k) ++seen[context.halo->indexOfAll(particles.wallBegin() + k)];
    job().sum(std::span(seen));
    for (std::size_t k = 0; k < position.size(); ++k) ASSERT_EQ(seen[k], 1u);
    for (std::size_t k = position.size() + 1; k < seen.size(); ++k) ASSERT_LE(seen[k], seen[k - 1]);
  }

  void check() { checkOwn(), checkGhosts(), checkWalls(), checkIndices(); }

  double imbalance() const {
    double most = 0;
    for (std::uint32_t count : job().all(particles.fluidCount)) most = std::max<double>(most, count);
    return most * job().size() / static_cast<double>(position.size());
  }
};

template <int D>
void followFlow(bool periodic) {
  Flow<D> flow(periodic, 3000, 1500);
  flow.sort();
  flow.check();
  EXPECT_LT(flow.imbalance(), 1.3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int step = 0; step < 6; ++step) {
    flow.move([&](Vec<D> x) {
      for (int k = 0; k < D; ++k) {
        x[k] += 0.3 * uniform(random) + (k == 0 ? 0.4 : 0);
        if (!periodic) x[k] = std::clamp(x[k], 0.0, flow.grid.length[k]);
      }
      return x;
    });
    flow.sort();
    flow.check();
  }
}

TEST(Decomposition, MovingFluid2D) { followFlow<2>(false); }
TEST(Decomposition, MovingFluid3D) { followFlow<3>(false); }
TEST(Decomposition, PeriodicFlow2D) { followFlow<2>(true); }
TEST(Decomposition, PeriodicFlow3D) { followFlow<3>(true); }

/// Fluid that gathers at one end is divided anew, in the sort after that which has seen it there.
TEST(Decomposition, CellsChangeHands) {
  Flow<2> flow(false, 4000, 100, 0.25);
  flow.sort();
  const auto expectBalanced = [&] {
    flow.sort();
    flow.check();
    flow.sort();
    flow.check();
    EXPECT_LT(flow.imbalance(), 1.2);
  };
  flow.move([](const Vec<2>& x) { return Vec<2>{0.4 * x[0], x[1]}; });
  expectBalanced();
  flow.move([](const Vec<2>& x) { return Vec<2>{x[0] + 4.8, x[1]}; });
  expectBalanced();
}

/// With all fluid in one cell there is nothing for the others; later there is again.
TEST(Decomposition, ProcessesWithoutFluid) {
  Flow<3> flow(false, 1000, 500);
  flow.sort();
  flow.move([](const Vec<3>& x) { return x * 0.1; });
  flow.sort();
  flow.check();
  EXPECT_EQ(flow.context.halo->someHaveNone, job().size() > 1);
  flow.move([](const Vec<3>& x) { return x * 10; });
  flow.sort();
  flow.check();
  EXPECT_FALSE(flow.context.halo->someHaveNone);
}

TEST(Decomposition, MoreProcessesThanCells) {
  Flow<2> flow(false, 10, 10);
  for (std::uint32_t i = 0; i < 10; ++i) flow.particles.position[i] = {0.5, 0.5 + 0.01 * i};
  if (job().size() > 1) {
    EXPECT_THROW(flow.sort(), InputError);
  } else {
    EXPECT_NO_THROW(flow.sort());
  }
}

/// A position that is not finite at one process ends the sort at all of them.
TEST(Decomposition, AgreesOnPositionsThatAreNotFinite) {
  Flow<2> flow(false, 1000, 10);
  flow.sort();
  if (job().rank() == job().size() - 1) flow.particles.position[0][1] = std::nan("");
  EXPECT_THROW(flow.sort(), RunError);
}

}  // namespace
}  // namespace treacle::test
