#include "treacle/search/column_blocks.hpp"

#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "treacle/search/neighbour_rows.hpp"

namespace treacle::test {
namespace {

using Blocks = ColumnBlocksView;

/// Whether a column has a place in a block, and which.
bool findPlace(const Blocks::Run* run, const Blocks::Size& size, std::uint32_t column, std::uint32_t& place) {
  for (std::uint32_t r = 0; r < size.runs; ++r) {
    const std::uint32_t length = (r + 1 < size.runs ? run[r + 1].place : size.columns) - run[r].place;
    if (column < run[r].begin || column >= run[r].begin + length) continue;
    place = run[r].place + (column - run[r].begin);
    return true;
  }
  return false;
}

/// Returns how many blocks have places; those must have one for each neighbour of their rows.
template <int D>
std::size_t checkBlocks(RandomParticles<D>& r, std::uint32_t fluid) {
  Context<Cuda> context;
  Particles<D, Cuda> device = onDevice(context, r.particles);
  CellRanges<Cuda> ranges;
  SortWorkspace<Cuda> workspace;
  sortByCell(context, r.grid, device, ranges, workspace);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  NeighbourRows<> rows;
  findNeighbours(r.context, r.sorted(r.particles, r.ranges), {0.6 * r.radius, r.radius}, RowKind::FluidOfFluid,
                 rows);
  ColumnBlocks<Cuda> found;
  findColumnBlocks<D>(context, r.grid, viewOf(ranges),
                      std::span<const Vec<D>>(device.position.span()).first(fluid), found);
  const Buffer<Blocks::Run> run = copyToHost(context, found.run);
  const Buffer<Blocks::Size> size = copyToHost(context, found.size);
  EXPECT_EQ(size.size(), (fluid + Blocks::rows - 1) / Blocks::rows);
  std::size_t withPlaces = 0;
  for (std::uint32_t i = 0; i < fluid; ++i) {
    const Blocks::Size& mine = size[i / Blocks::rows];
    const Blocks::Run* runs = run.data() + std::size_t{i / Blocks::rows} * Blocks::runs;
    withPlaces += i % Blocks::rows == 0 && mine.runs > 0;
    if (mine.runs == 0) continue;
    EXPECT_LE(mine.runs, Blocks::runs);
    EXPECT_LE(mine.columns, Blocks::columns);
    rows.view().forEachPlace(i, [&](std::uint64_t k) {
      std::uint32_t place = Blocks::columns;
      EXPECT_TRUE(findPlace(runs, mine, rows.column[k], place));
      EXPECT_LT(place, mine.columns);
    });
  }
  return withPlaces;
}

template <int D>
void checkColumnBlocksSizes() {
  for (const std::uint32_t fluid : {0u, 1u, 127u, 129u, 20011u}) {
    SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid");
    RandomParticles<D> r(fluid, 33, fluid + 5);
    const std::size_t withPlaces = checkBlocks(r, fluid);
    EXPECT_EQ(withPlaces > 0, fluid > 0);
  }
}

TEST(ColumnBlocksTwin, HoldTheNeighboursOfTheirRows) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkColumnBlocksSizes<2>();
  checkColumnBlocksSizes<3>();
}

}  // namespace
}  // namespace treacle::test
