#include "treacle/search/decomposition.hpp"

#include "mpi/job.hpp"
#include "support/equal_blocks.hpp"
#include "support/gpu.hpp"
#include "treacle/core/device_link.hpp"
#include "treacle/model/particles/particle_part.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/search/fluid_change.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace treacle::test {
namespace {

constexpr std::uint32_t modes = 2;

/// What the fields of a particle hold that it takes along, by which it is known again.
double mark(std::uint32_t id, int field) { return 1000.0 * field + std::sqrt(1.0 + id); }

/// Particles that move, the same at all processes, and the part of them that is this one's: at first so many of
/// the fluid, whichever their places. Tests change and look at those in the host's memory, wherever they are
/// sorted.
template <int D, class Backend>
struct Flow {
  static constexpr bool isOnHost = std::is_same_v<Backend, Cpu>;

  CellGrid<D> grid;
  std::vector<Vec<D>> position, wallPosition;  // of all fluid, and of all walls, by id
  Context<Backend> context;
  DeviceOnly<std::unique_ptr<DeviceLink>, Backend> link;
  DeviceOnly<Particles<D, Cuda>, Backend> deviceParticles;
  DeviceOnly<CellRanges<Cuda>, Backend> deviceRanges;
  Decomposition<D, Backend> decomposition;
  Particles<D> particles;
  CellRanges<> ranges;
  SortWorkspace<Backend> workspace;
  bool hasModes = true;  // they are dropped where some process has no fluid

  Flow(bool periodic, std::uint32_t fluid, std::uint32_t walls, double radius = 1) {
    Vec<D> lo{}, hi{};
    Vec<D, bool> ends{};
    for (int k = 0; k < D; ++k) hi[k] = k == 0 ? 8 : 5.5, ends[k] = periodic;
    grid = CellGrid<D>::make(lo, hi, ends, radius);
    context.communicator = &job();
    if constexpr (!isOnHost) {
      link = DeviceLink::make(job(), context);
      context.link = link.get();
    }
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::uint32_t i = 0; i < fluid + walls; ++i) {
      Vec<D> x;
      for (int k = 0; k < D; ++k) x[k] = uniform(random) * hi[k];
      (i < fluid ? position : wallPosition).push_back(x);
    }
    const ParticlePart part{static_cast<std::uint32_t>(job().rank()), static_cast<std::uint32_t>(job().size())};
    const std::uint32_t begin = part.begin(fluid), size = part.size(fluid);
    particles.resize({size, walls, modes, walls, 0, {true, true, true, 2, 1}});
    for (std::uint32_t k = 0; k < particles.count; ++k) {
      const std::uint32_t i = k < size ? begin + k : fluid + (k - size);
      particles.position[k] = i < fluid ? position[i] : wallPosition[i - fluid];
      if (i >= fluid) particles.wallSurface[i - fluid] = {{{static_cast<float>(mark(i, 8))}, {}}};
      particles.id[k] = i;
      particles.material[k] = static_cast<std::uint8_t>(i % 3);
      particles.body[k] = static_cast<std::uint8_t>(i % 5);
      particles.pressure[k] = mark(i, 1);
      particles.numberDensity[k] = mark(i, 2);
      particles.heldPressure[k] = mark(i, 12);
      particles.velocity[k] = {mark(i, 3)};
    }
    for (std::uint32_t k = 0; k < size; ++k) {
      particles.acceleration[k] = {mark(begin + k, 4)};
      particles.jerk[k] = {mark(begin + k, 5)};
      particles.shearRate[k] = mark(begin + k, 9);
      particles.temperature[k] = mark(begin + k, 10);
      particles.viscosityFactor[k] = mark(begin + k, 11);
      particles.conformation[0][k] = mark(begin + k, 15) * SymmetricBlock<D>::identity();
      for (std::size_t s = 0; s < 2; ++s) particles.states[s][k] = mark(begin + k, 13 + static_cast<int>(s));
      for (std::uint32_t m = 0; m < modes; ++m)
        particles.modes.vectors[m * size + k] = {static_cast<float>(mark(begin + k, 6 + m))};
    }
  }

  void sort() {
    if constexpr (isOnHost) {
      decomposition.sort(context, grid, particles, ranges, workspace);
    } else {
      copyToDevice(context, particles, deviceParticles);
      decomposition.sort(context, grid, deviceParticles, deviceRanges, workspace);
      copyToHost(context, deviceParticles, particles);
      ranges.activeCount = deviceRanges.activeCount, ranges.ghostWalls = deviceRanges.ghostWalls;
      ranges.fluidBegin = copyToHost(context, deviceRanges.fluidBegin);
      ranges.fluidEnd = copyToHost(context, deviceRanges.fluidEnd);
      ranges.wallBegin = copyToHost(context, deviceRanges.wallBegin);
      ranges.wallEnd = copyToHost(context, deviceRanges.wallEnd);
      ranges.key = copyToHost(context, deviceRanges.key);
    }
    hasModes = hasModes && !context.halo->someHaveNone;
  }

  /// Brings what ghosts have from their owners.
  void fillGhostsOf(std::vector<std::uint32_t>& values) {
    if constexpr (isOnHost) {
      fillGhosts(context, Held::Active, values.data());
    } else {
      Buffer<std::uint32_t, Cuda> onDevice = copyToDevice(context, std::span<const std::uint32_t>(values));
      fillGhosts(context, Held::Active, onDevice.data());
      copyBytesToHost(context, onDevice.data(), values.data(), values.size() * sizeof(std::uint32_t));
    }
  }

  /// Indices that are sent, in the host's memory.
  std::vector<std::uint32_t> sent(const Buffer<std::uint32_t, Backend>& list) const {
    std::vector<std::uint32_t> host(list.size());
    copyToHost(context, list.span(), host.data());
    return host;
  }

  /// Moves everything, then what this process owns, and all walls.
  template <class F>
  void move(F&& to) {
    for (std::vector<Vec<D>>* group : {&position, &wallPosition})
      for (Vec<D>& x : *group) {
        x = to(x);
        ASSERT_TRUE(grid.wrap(x));
      }
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i) particles.position[i] = position[particles.id[i]];
    for (std::uint32_t i = particles.wallBegin(); i < particles.count; ++i)
      particles.position[i] = wallPosition[particles.id[i] - position.size()];
  }

  std::size_t cellOf(const Vec<D>& x) const { return grid.linear(grid.cellOf(x)); }
  bool isOwn(std::size_t cell) const { return decomposition.owners().owner(cell) == job().rank(); }

  /// Every particle is somebody's, once; own ones stand in own cells, with what they brought along.
  void checkOwn() const {
    const Particles<D>& p = particles;
    std::vector<std::uint32_t> owners(position.size());
    if (p.fluidCount > 0) {
      EXPECT_EQ(p.modeCount(), hasModes ? modes : 0);
    }
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const std::uint32_t id = p.id[i];
      ++owners[id];
      EXPECT_TRUE(isOwn(cellOf(p.position[i])));
      EXPECT_EQ(p.position[i], position[id]);
      EXPECT_EQ(p.pressure[i], mark(id, 1));
      EXPECT_EQ(p.numberDensity[i], mark(id, 2));
      EXPECT_EQ(p.heldPressure[i], mark(id, 12));
      EXPECT_EQ(p.velocity[i][0], mark(id, 3));
      EXPECT_EQ(p.acceleration[i][0], mark(id, 4));
      EXPECT_EQ(p.jerk[i][0], mark(id, 5));
      EXPECT_EQ(p.shearRate[i], mark(id, 9));
      EXPECT_EQ(p.temperature[i], mark(id, 10));
      EXPECT_EQ(p.viscosityFactor[i], mark(id, 11));
      EXPECT_EQ(p.conformation[0][i](D - 1, D - 1), mark(id, 15));
      for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(p.states[s][i], mark(id, 13 + static_cast<int>(s)));
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
    fillGhostsOf(id);
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
    EXPECT_EQ(p.wallCount(), wallPosition.size());
    std::vector<std::uint8_t> nearFluid(grid.cellCount());
    for (const Vec<D>& x : position)
      forEachAdjacentCell(grid, grid.cellOf(x), [&](const Vec<D, int>& c) { nearFluid[grid.linear(c)] = 1; });
    std::vector<std::uint32_t> owners(p.wallCount()), expected(p.wallCount());
    for (std::uint32_t i = p.wallBegin(); i < p.count; ++i) {
      const std::size_t k = p.id[i] - position.size(), cell = cellOf(p.position[i]);
      EXPECT_EQ(p.pressure[i], mark(p.id[i], 1));
      EXPECT_EQ(p.position[i], wallPosition[k]);
      EXPECT_EQ(p.wallSurface[i - p.wallBegin()].face[0][0], static_cast<float>(mark(p.id[i], 8)));
      if (i < ranges.activeCount) {
        EXPECT_LE(ranges.wallBegin[cell], i);
        EXPECT_GT(ranges.wallEnd[cell], i);
      }
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
    std::vector<std::uint32_t> seen(position.size() + wallPosition.size());
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

template <int D, class Backend>
void followFlow(bool periodic) {
  Flow<D, Backend> flow(periodic, 3000, 1500);
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

struct BackendName {
  template <class Backend>
  static std::string GetName(int) {
    return std::is_same_v<Backend, Cpu> ? "Cpu" : "Cuda";
  }
};

template <class Backend>
class DecompositionTest : public testing::Test {
 protected:
  void SetUp() override {
    if (std::is_same_v<Backend, Cpu>) return;
    TREACLE_SKIP_WITHOUT_GPU();
    useOwnDevice();
  }
};

#ifdef TREACLE_HAS_CUDA
using Backends = testing::Types<Cpu, Cuda>;
#else
using Backends = testing::Types<Cpu>;
#endif
TYPED_TEST_SUITE(DecompositionTest, Backends, BackendName);

TYPED_TEST(DecompositionTest, MovingFluid2D) { followFlow<2, TypeParam>(false); }
TYPED_TEST(DecompositionTest, MovingFluid3D) { followFlow<3, TypeParam>(false); }
TYPED_TEST(DecompositionTest, PeriodicFlow2D) { followFlow<2, TypeParam>(true); }
TYPED_TEST(DecompositionTest, PeriodicFlow3D) { followFlow<3, TypeParam>(true); }

/// Fluid that gathers at one end is divided anew, in the sort after that which has seen it there.
TYPED_TEST(DecompositionTest, CellsChangeHands) {
  Flow<2, TypeParam> flow(false, 4000, 100, 0.25);
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

/// Processes that give all their fluid away and get other fluid for it: two heaps change places.
TYPED_TEST(DecompositionTest, AllFluidIsExchanged) {
  Flow<2, TypeParam> flow(false, 3000, 0, 0.5);
  flow.move([](const Vec<2>& x) { return Vec<2>{x[0] < 4 ? 0.24 * x[0] : 8 - 0.24 * (8 - x[0]), 0.45 * x[1]}; });
  flow.sort();
  const std::vector<std::uint32_t> before(flow.particles.id.begin(),
                                          flow.particles.id.begin() + flow.particles.fluidCount);
  flow.move([](const Vec<2>& x) { return Vec<2>{8 - x[0], x[1]}; });
  flow.sort();
  flow.check();
  EXPECT_TRUE(flow.hasModes);
  if (job().size() % 2 == 0) {
    for (std::uint32_t i = 0; i < flow.particles.fluidCount; ++i)
      EXPECT_EQ(std::ranges::count(before, flow.particles.id[i]), 0);
  }
}

/// With all fluid in one cell there is nothing for the others; later there is again.
TYPED_TEST(DecompositionTest, ProcessesWithoutFluid) {
  Flow<3, TypeParam> flow(false, 1000, 500);
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

/// All fluid is one process's where it fills a single cell. Then more comes, to the first process and into many
/// cells, and every process gets some of it, though none could have had before.
TYPED_TEST(DecompositionTest, MoreProcessesThanCells) {
  Flow<2, TypeParam> flow(false, 40, 100, 0.25);
  for (std::uint32_t i = 0; i < flow.particles.fluidCount; ++i)
    flow.particles.position[i] = {0.6, 0.51 + 0.005 * i};
  flow.sort();
  EXPECT_EQ(std::ranges::count(job().all(flow.particles.fluidCount), 0u), job().size() - 1);
  Particles<2> added;
  added.resize({job().rank() == 0 ? 2000u : 0u, 0, 0, 0, 0, flow.particles.has});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 5);
  for (std::uint32_t i = 0; i < added.count; ++i) {
    added.position[i] = {uniform(random), uniform(random)};
    added.id[i] = 1000 + i;
  }
  Context<Cpu> host;
  flow.particles.modes.drop();
  changeFluid<2>(host, {}, added, flow.particles);
  flow.sort();
  flow.sort();
  const std::vector<std::uint32_t> own = job().all(flow.particles.fluidCount);
  EXPECT_LT(*std::ranges::max_element(own), 1.2 * 2040 / job().size());
}

/// A position that is not finite at one process ends the sort at all of them.
TYPED_TEST(DecompositionTest, AgreesOnPositionsThatAreNotFinite) {
  Flow<2, TypeParam> flow(false, 1000, 10);
  flow.sort();
  if (job().rank() == job().size() - 1) flow.particles.position[0][1] = std::nan("");
  EXPECT_THROW(flow.sort(), RunError);
}

#ifdef TREACLE_HAS_CUDA
template <class T>
void expectSame(const Buffer<T>& a, const Buffer<T>& b, std::size_t begin, std::size_t end) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(std::equal(a.begin() + begin, a.begin() + end, b.begin() + begin));
}
template <class T>
void expectSame(const Buffer<T>& a, const Buffer<T>& b) {
  expectSame(a, b, 0, a.size());
}

/// Own particles, ghosts, their order, where cells have them and what is sent to whom.
template <int D>
void expectSame(const Flow<D, Cpu>& cpu, const Flow<D, Cuda>& device) {
  const Particles<D>&a = cpu.particles, &b = device.particles;
  ASSERT_EQ(a.numbers(), b.numbers());
  forEachSharedFieldOf(
      [&](const auto& x, const auto& y) {
        expectSame(x, y, 0, a.fluidCount);
        expectSame(x, y, a.wallBegin(), a.count);
      },
      a, b);
  expectSame(a.position, b.position);
  expectSame(a.material, b.material);
  forEachFluidFieldOf([&](const auto& x, const auto& y) { expectSame(x, y); }, a, b);
  expectSame(a.modes.vectors, b.modes.vectors);
  expectSame(a.wallSurface, b.wallSurface);

  EXPECT_EQ(cpu.ranges.activeCount, device.ranges.activeCount);
  EXPECT_EQ(cpu.ranges.ghostWalls, device.ranges.ghostWalls);
  expectSame(cpu.ranges.fluidBegin, device.ranges.fluidBegin);
  expectSame(cpu.ranges.fluidEnd, device.ranges.fluidEnd);
  expectSame(cpu.ranges.wallBegin, device.ranges.wallBegin);
  expectSame(cpu.ranges.wallEnd, device.ranges.wallEnd);
  expectSame(cpu.ranges.key, device.ranges.key);

  const Halo<Cpu>& haloA = *cpu.context.halo;
  const Halo<Cuda>& haloB = *device.context.halo;
  EXPECT_EQ(haloA.ownFluid, haloB.ownFluid);
  EXPECT_EQ(haloA.fluid, haloB.fluid);
  EXPECT_EQ(haloA.ownWalls, haloB.ownWalls);
  EXPECT_EQ(haloA.fluidBefore, haloB.fluidBefore);
  EXPECT_EQ(haloA.wallsBefore, haloB.wallsBefore);
  EXPECT_EQ(haloA.fluidOfAll, haloB.fluidOfAll);
  EXPECT_EQ(haloA.someHaveNone, haloB.someHaveNone);
  ASSERT_EQ(haloA.neighbours.size(), haloB.neighbours.size());
  for (std::size_t k = 0; k < haloA.neighbours.size(); ++k) {
    const auto& n = haloA.neighbours[k];
    const auto& m = haloB.neighbours[k];
    EXPECT_EQ(n.rank, m.rank);
    EXPECT_EQ(n.sentFluid, m.sentFluid);
    EXPECT_EQ(n.sentWalls, m.sentWalls);
    EXPECT_EQ(n.fluid, m.fluid);
    EXPECT_EQ(n.walls, m.walls);
  }
  EXPECT_EQ(cpu.sent(haloA.sentFluid), device.sent(haloB.sentFluid));
  EXPECT_EQ(cpu.sent(haloA.sentWalls), device.sent(haloB.sentWalls));
}

/// Fluid that is stirred, drifts and gathers, so that it changes hands by itself and with its cells.
template <int D>
void compareBackends(bool periodic) {
  TREACLE_SKIP_WITHOUT_GPU();
  useOwnDevice();
  Flow<D, Cpu> cpu(periodic, 12000, 5000, 0.5);
  Flow<D, Cuda> device(periodic, 12000, 5000, 0.5);
  for (int step = 0; step < 8; ++step) {
    cpu.sort(), device.sort();
    expectSame(cpu, device);
    if (testing::Test::HasFatalFailure()) return;
    const auto stir = [&](auto& flow) {
      std::mt19937 random(step);
      std::uniform_real_distribution<double> uniform(-1, 1);
      flow.move([&](Vec<D> x) {
        for (int k = 0; k < D; ++k) x[k] = std::clamp(x[k] + 0.2 * uniform(random), 0.0, flow.grid.length[k]);
        x[0] *= step < 4 ? 0.8 : 1;
        return x;
      });
    };
    stir(cpu), stir(device);
  }
}

TEST(DecompositionOnDevice, IsThatOfTheCpu2D) { compareBackends<2>(false); }
TEST(DecompositionOnDevice, IsThatOfTheCpu3D) { compareBackends<3>(false); }
TEST(DecompositionOnDevice, IsThatOfTheCpuInPeriodicDomains) { compareBackends<3>(true); }
#endif

}  // namespace
}  // namespace treacle::test
