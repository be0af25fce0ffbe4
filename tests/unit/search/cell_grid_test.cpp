#include "treacle/search/cell_grid.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace treacle {
namespace {

/// A domain of any size has a grid, whose cells are no smaller than the radius and whose keys fit into 63 bits.
template <int D>
void checkExtents() {
  for (const double extent : {1e-3, 1.0, 1e6, 4e6, 1e9, 1e15, 1e300, std::numeric_limits<double>::max()}) {
    const auto grid = CellGrid<D>::make({}, Vec<D>::filled(extent), {}, 3.5e-3);
    EXPECT_GE(grid.bits, 1);
    EXPECT_LE(D * (grid.bits + CellGrid<D>::subBits), 63);
    for (int k = 0; k < D; ++k) {
      EXPECT_GE(grid.count[k], 1);
      EXPECT_LE(grid.count[k], 1 << grid.bits);
      EXPECT_TRUE(grid.count[k] == 1 || grid.edge[k] >= 3.5e-3 * (1 - 1e-9));
    }
    EXPECT_EQ(grid.key(Vec<D>::filled(extent)) >> 63, 0u);
    EXPECT_EQ(grid.cellOf(Vec<D>::filled(extent))[0], grid.count[0] - 1);
  }
}

TEST(CellGrid, endsForEveryExtent) {
  checkExtents<2>();
  checkExtents<3>();
}

}  // namespace
}  // namespace treacle
