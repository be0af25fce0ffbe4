#include "treacle/search/cluster_list.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

namespace treacle::test {
namespace {

void expectSameLists(const Context<Cuda>& context, const ClusterList<>& expected, const ClusterList<Cuda>& found) {
  EXPECT_EQ(found.first, expected.first);
  EXPECT_EQ(found.last, expected.last);
  expectSameBits(context, expected.offset, found.offset);
  expectSameBits(context, expected.entry, found.entry);
  expectSameBits(context, expected.special, found.special);
}

template <int D>
void checkClusterListSizes() {
  Context<Cuda> context;
  for (const bool sheets : {false, true})
    for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u})
      for (std::uint32_t wall : {0u, 1u, 3000u}) {
        SCOPED_TRACE(testing::Message() << fluid << " fluid and " << wall << " wall particles, " << D << "D");
        RandomParticles<D> r(fluid, wall, fluid + wall + 4);
        if (sheets) r.addSides(fluid);
        sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
        Particles<D, Cuda> particles = onDevice(context, r.particles);
        CellRanges<Cuda> ranges;
        SortWorkspace<Cuda> workspace;
        sortByCell(context, r.grid, particles, ranges, workspace);

        ClusterList<> expected;
        ClusterList<Cuda> found;
        for (const bool walls : {false, true}) {
          const std::uint32_t first = walls ? fluid : 0, last = walls ? r.ranges.activeCount : fluid;
          const ListRadii radii{r.radius / 2, walls ? 0 : r.radius};
          ListScope scope{first, last, radii, walls, sheets ? r.particles.side.data() : nullptr};
          buildClusterList<D>(r.context, r.grid, r.ranges, r.particles.position, scope, expected);
          scope.side = sheets ? particles.side.data() : nullptr;
          buildClusterList<D>(context, r.grid, ranges, particles.position, scope, found);
          expectSameLists(context, expected, found);
        }
      }
}

TEST(ClusterListTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkClusterListSizes<2>();
  checkClusterListSizes<3>();
}

}  // namespace
}  // namespace treacle::test
