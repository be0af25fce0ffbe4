#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

namespace treacle::test {
namespace {

template <int D>
struct DeviceSort {
  Context<Cuda> context;
  CellRanges<Cuda> ranges;
  SortWorkspace<Cuda> workspace;

  /// Sorts a copy of the particles here and the particles themselves on the CPU, and compares.
  void check(RandomParticles<D>& r) {
    Particles<D, Cuda> device = onDevice(context, r.particles);
    sortByCell(context, r.grid, device, ranges, workspace);
    sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
    EXPECT_EQ(device.fluidCount, r.particles.fluidCount);
    EXPECT_EQ(device.count, r.particles.count);
    forEachFieldOf([&](const auto& a, const auto& b) { expectSameBits(context, a, b); }, r.particles, device);
    EXPECT_EQ(ranges.activeCount, r.ranges.activeCount);
    expectSameBits(context, r.ranges.fluidBegin, ranges.fluidBegin);
    expectSameBits(context, r.ranges.fluidEnd, ranges.fluidEnd);
    expectSameBits(context, r.ranges.wallBegin, ranges.wallBegin);
    expectSameBits(context, r.ranges.wallEnd, ranges.wallEnd);
    expectSameBits(context, r.ranges.key, ranges.key);
  }
};

template <int D>
void checkCellSortSizes() {
  DeviceSort<D> sort;
  for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u})
    for (std::uint32_t wall : {0u, 1u, 33u, 7001u}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid, " << wall << " wall particles");
      RandomParticles<D> r(fluid, wall, fluid + 3 * wall + 7);
      for (std::uint32_t i = 0; i < r.particles.count; ++i) {
        r.particles.pressure[i] = 1.5 * i;
        r.particles.numberDensity[i] = -0.25 * i;
        r.particles.material[i] = static_cast<std::uint8_t>(i % 5);
      }
      sort.check(r);
    }
}

TEST(CellSortTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkCellSortSizes<2>();
  checkCellSortSizes<3>();
}

TEST(CellSortTwin, KeepsTheSameWallsActiveAroundRigidBodies) {
  TREACLE_SKIP_WITHOUT_GPU();
  RandomParticles<2> plane(4000, 2000, 3);
  RandomParticles<3> space(4000, 2000, 3);
  plane.addRigidBody(), space.addRigidBody();
  DeviceSort<2>().check(plane);
  DeviceSort<3>().check(space);
}

TEST(CellSortTwin, KeepsTheOrderOfEqualKeys) {
  TREACLE_SKIP_WITHOUT_GPU();
  RandomParticles<3> r(5000, 3000, 3);
  for (std::uint32_t i = 0; i < r.particles.count; ++i)
    r.particles.position[i] = i % 3 == 0 ? Vec<3>{0.5, 0.5, 0.25} : Vec<3>{0.25, 0.5, 0.25};
  DeviceSort<3>().check(r);
}

TEST(CellSortTwin, FollowsTheFluidFromSortToSort) {
  TREACLE_SKIP_WITHOUT_GPU();
  RandomParticles<2> r(2000, 1000, 5);
  DeviceSort<2> sort;
  for (int step = 0; step < 3; ++step) {
    sort.check(r);
    for (std::uint32_t i = 0; i < r.particles.fluidCount; ++i) {
      r.particles.position[i] += 0.1 * r.particles.velocity[i];
      r.grid.wrap(r.particles.position[i]);
    }
  }
}

}  // namespace
}  // namespace treacle::test
