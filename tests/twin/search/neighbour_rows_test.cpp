#include "treacle/search/neighbour_rows.hpp"

#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

namespace treacle::test {
namespace {

template <int D>
void checkRows(Context<Cuda>& context, RandomParticles<D>& r, NeighbourRows<Cuda>& found) {
  const std::uint32_t fluid = r.particles.fluidCount;
  Particles<D, Cuda> device = onDevice(context, r.particles);
  CellRanges<Cuda> ranges;
  SortWorkspace<Cuda> workspace;
  sortByCell(context, r.grid, device, ranges, workspace);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  SortedParticles<D> here = r.sorted(r.particles, r.ranges), there = r.sorted(device, ranges);
  for (const std::uint32_t parts : {0u, 3u})  // a third of all are ghosts
    for (const RowKind kind : {RowKind::FluidOfFluid, RowKind::WallsOfFluid, RowKind::FluidOfWalls}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid, " << r.particles.count - fluid
                                      << " walls, kind " << static_cast<int>(kind) << ", parts " << parts);
      here.ghostFluid = there.ghostFluid = parts == 0 ? 0 : fluid / parts;
      here.ghostWalls = there.ghostWalls = parts == 0 ? 0 : (here.activeCount - fluid) / parts;
      const RowRadii radii{0.6 * r.radius, r.radius};
      NeighbourRows<> expected;
      findNeighbours(r.context, here, radii, kind, expected);
      findNeighbours(context, there, radii, kind, found);
      EXPECT_EQ(found.first, expected.first);
      EXPECT_EQ(found.count, expected.count);
      expectSameBits(context, expected.start, found.start);
      expectSameBits(context, expected.column, found.column);
    }
}

template <int D>
void checkNeighbourRowsSizes() {
  Context<Cuda> context;
  NeighbourRows<Cuda> found;  // what it keeps must fit the next search, too
  for (std::uint32_t fluid : {0u, 20011u, 1u, 31u, 33u})
    for (std::uint32_t wall : {0u, 1u, 33u, 7001u}) {
      RandomParticles<D> r(fluid, wall, fluid + 3 * wall + 7);
      checkRows(context, r, found);
    }
  RandomParticles<D> divided(20011, 7001, 5);
  divided.addSides(5);
  checkRows(context, divided, found);
  // More in most cells than a word has bits, and more in rows than a block brings together.
  RandomParticles<D> r(20011, 7001, 1);
  r.radius *= 2;
  r.grid = CellGrid<D>::make(Vec<D>{}, Vec<D>::filled(1), r.grid.periodic, r.radius);
  checkRows(context, r, found);
}

TEST(NeighbourRowsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkNeighbourRowsSizes<2>();
  checkNeighbourRowsSizes<3>();
}

}  // namespace
}  // namespace treacle::test
