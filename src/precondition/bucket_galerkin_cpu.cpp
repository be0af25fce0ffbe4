#include "treacle/precondition/bucket_galerkin.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/mph_neighbours.hpp"
#include "treacle/precondition/bucket_cells.hpp"

#include <array>

namespace treacle {
namespace {

constexpr std::uint32_t noBucket = ~std::uint32_t{0};

/// (R C)_{I k} of own particles k: the sum of C_ik over the fluid particles i of each cell I.
template <bool Renormalised, int D>
void restrictedColumns(const MphPairs<D>& pairs, Buffer<Vec<D>>& columns) {
  constexpr int slots = power<D>(2);
  columns.resize(std::size_t{slots} * pairs.activeCount);
  parallelFor(pairs.activeCount, parallelGrain, [&](std::size_t index) {
    const auto k = static_cast<std::uint32_t>(index);
    if (!pairs.isOwn(k)) return;
    const Vec<D>& xk = pairs.position[k];
    const Vec<D, int> cell = pairs.grid.cellOf(xk), lower = lowerCell(pairs.grid, xk, cell);
    Vec<D>* column = &columns[std::size_t{slots} * k];
    std::fill_n(column, slots, Vec<D>{});
    Vec<D> own{};
    forEachNear(pairs, k, [&](std::uint32_t j, const Vec<D>&, const Vec<D>& plain) {
      const Vec<D> g = Renormalised ? pairs.corrected(k, plain) : plain;
      own += g;
      if (j >= pairs.fluidCount) return;
      const int slot = columnSlot<D>(cellOffset(pairs.grid, cell, pairs.grid.cellOf(pairs.position[j])) - lower);
      if (slot >= 0) column[slot] -= g;  // else at distance h_p to rounding, where g vanishes
    });
    if (k < pairs.fluidCount) column[columnSlot<D>(-lower)] += own;
  });
}

/// One row of A^0 on the 3^D adjacent cells: what the process's own particles put there, and, where the bucket is
/// its own, all else.
template <int D>
struct BucketRow {
  static constexpr int neighbours = power<D>(3);
  static constexpr int self = neighbours / 2;

  const MphPairs<D>& pairs;
  const CellRanges<>& ranges;
  const BucketLevels<>& levels;
  std::uint32_t begin = 0, end = 0;  // the bucket's particles
  bool isOwn = true;
  std::array<AdjacentCell<D>, neighbours> cell{};
  std::array<std::uint32_t, neighbours> bucket{};  // noBucket: outside the domain or empty
  std::array<Block<D>, neighbours> block{};

  BucketRow(const MphPairs<D>& p, const CellRanges<>& r, const BucketLevels<>& l, std::uint32_t b)
      : pairs(p), ranges(r), levels(l), begin(l.begin[0][b]), end(l.begin[0][b + 1]), isOwn(p.isOwn(begin)) {
    const Vec<D, int> own = p.grid.cellOf(p.position[begin]);
    for (int o = 0; o < neighbours; ++o) {
      cell[o] = {p.grid, own, adjacentOffset<D>(o)};
      bucket[o] = cell[o].occupied(viewOf(r)) ? l.bucketOf[r.fluidBegin[cell[o].linear]] : noBucket;
    }
  }

  void addPressure(const Buffer<Vec<D>>& columns) {
    const OwnRanges own = pairs.ownRanges();
    for (int o = 0; o < neighbours; ++o) {
      if (!cell[o].inside) continue;
      addColumns(o, own.fluid(cell[o].linear), columns);
      addColumns(o, own.walls(cell[o].linear), columns);
    }
  }

  /// Pairs inside the bucket cancel in the sum; pairs across give -c d d^T there and +c d d^T here.
  void addViscosity() {
    for (int o = 0; o < neighbours; ++o) {
      if (o == self || bucket[o] == noBucket) continue;
      const std::size_t at = cell[o].linear;
      const Block<D> cross = crossViscosity(ranges.fluidBegin[at], ranges.fluidEnd[at], cell[o].shift);
      block[o] -= cross;
      block[self] += cross;
    }
  }

 private:
  void addColumns(int o, const IndexRange& particles, const Buffer<Vec<D>>& columns) {
    constexpr int slots = power<D>(2);
    const Vec<D, int> offset = adjacentOffset<D>(o);
    for (std::uint32_t k = particles.begin; k < particles.end; ++k) {
      const Vec<D>& xk = pairs.position[k];
      const Vec<D, int> lower = offset + lowerCell(pairs.grid, xk, cell[o].cell);
      const int mine = columnSlot<D>(-lower);
      if (mine < 0) continue;
      const Vec<D>* column = &columns[std::size_t{slots} * k];
      if (norm2(column[mine]) == 0) continue;  // k's neighbourhood does not reach into this bucket
      const double lambda = pairs.bulkViscosity(k);
      for (int s = 0; s < slots; ++s) {
        block[adjacentIndex<D>(lower + digits<D>(s, 2))].addOuter(lambda, column[mine], column[s]);
      }
    }
  }

  Block<D> crossViscosity(std::uint32_t first, std::uint32_t last, const Vec<D>& shiftBy) const {
    const double floor2 = distanceFloor2(pairs), farAway = 1e6 * pairs.terms.viscosityRadius;
    Lanes sum[D][D] = {};
    for (std::uint32_t j = first; j < last; j += clusterSize) {
      const ClusterRange range(j, last);
      const ViscosityLanes<D> viscosity(pairs, range);
      VecLanes<D> x = loadLanes<D>(range, pairs.position);
      for (int k = 0; k < D; ++k) x[k] += shiftBy[k];
      for (std::uint32_t lane = range.count; lane < clusterSize; ++lane) x[0][lane] += farAway;
      for (std::uint32_t i = begin; i < end; ++i) {
        const PairLanes<D> pair(pairs.position[i], x, floor2);
        const Lanes f = pairs.terms.viscous(viscosity.with(i), pair.r);
        for (int r = 0; r < D; ++r)
          for (int k = 0; k < D; ++k) sum[r][k] += f * pair.d[r] * pair.d[k];
      }
    }
    Block<D> total{};
    for (int lane = 0; lane < laneCount; ++lane)
      for (int r = 0; r < D; ++r)
        for (int k = 0; k < D; ++k) total(r, k) += sum[r][k][lane];
    return total;
  }
};

}  // namespace

template <int D>
void bucketGalerkin(Context<Cpu>&, const MphPairs<D>& pairs, const CellRanges<>& ranges,
                    const BucketLevels<>& levels, const WallTerms<D>& terms, Buffer<Vec<D>>& columns,
                    BlockCsr<D>& a0) {
  constexpr int neighbours = BucketRow<D>::neighbours;
  withRenormalisation(pairs, [&]<bool Renormalised>() { restrictedColumns<Renormalised>(pairs, columns); });

  const std::uint32_t rows = levels.count(0);
  a0.rowStart.resize(rows + 1);
  a0.rowStart[0] = 0;
  for (std::uint32_t b = 0; b < rows; ++b) {
    const BucketRow<D> row(pairs, ranges, levels, b);
    const auto occupied = neighbours - std::count(row.bucket.begin(), row.bucket.end(), noBucket);
    a0.rowStart[b + 1] = a0.rowStart[b] + occupied;
  }
  a0.column.resize(a0.rowStart[rows]);
  a0.value.resize(a0.rowStart[rows]);

  parallelForDynamic(rows, 8, 8, [&](std::size_t b) {
    BucketRow<D> row(pairs, ranges, levels, static_cast<std::uint32_t>(b));
    row.addPressure(columns);
    if (row.isOwn) {
      row.addViscosity();
      for (std::uint32_t i = row.begin; i < row.end; ++i) row.block[BucketRow<D>::self] += terms.block[i];
    }

    std::array<int, neighbours> order;
    for (int o = 0; o < neighbours; ++o) order[o] = o;
    std::sort(order.begin(), order.end(), [&](int p, int q) { return row.bucket[p] < row.bucket[q]; });
    for (std::uint64_t k = a0.rowStart[b]; k < a0.rowStart[b + 1]; ++k) {
      const int o = order[k - a0.rowStart[b]];
      a0.column[k] = row.bucket[o];
      a0.value[k] = row.block[o];
    }
  });
}

template void bucketGalerkin<2>(Context<Cpu>&, const MphPairs<2>&, const CellRanges<>&, const BucketLevels<>&,
                                const WallTerms<2>&, Buffer<Vec<2>>&, BlockCsr<2>&);
template void bucketGalerkin<3>(Context<Cpu>&, const MphPairs<3>&, const CellRanges<>&, const BucketLevels<>&,
                                const WallTerms<3>&, Buffer<Vec<3>>&, BlockCsr<3>&);

}  // namespace treacle
