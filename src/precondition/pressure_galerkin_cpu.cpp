#include "hat_loops.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/precondition/hat_grid.hpp"

#include <algorithm>
#include <array>

namespace treacle {
namespace {

template <int D>
constexpr int slots = D == 2 ? 9 : 27;  // nodes that the neighbours of a particle touch

/// sum += what the 3^D hats are at s, counted from the lowest node, times v; eight particles at once.
template <int D>
void addHats(const VecLanes<D>& s, const VecLanes<D>& v, VecLanes<D> (&sum)[slots<D>]) {
  Lanes hat[D][3];
  for (int k = 0; k < D; ++k)
    for (int n = 0; n < 3; ++n) {
      const Lanes away = s[k] - static_cast<double>(n);
      hat[k][n] = positivePart(1 - max(away, -away));
    }
  VecLanes<D> row[3];  // the last axis and v, for all nodes of it
  for (int n = 0; n < 3; ++n)
    for (int k = 0; k < D; ++k) row[n][k] = hat[D - 1][n] * v[k];
  for (int n = 0; n < slots<D>; ++n) {
    Lanes weight = hat[0][n % 3];
    if constexpr (D == 3) weight *= hat[1][n / 3 % 3];
    for (int k = 0; k < D; ++k) sum[n][k] += weight * row[n / (slots<D> / 3)][k];
  }
}

/// (C P)_in of each fluid particle i for the 3^D nodes n around it.
template <bool Renormalised, int D, class T>
void pressureColumns(const MphPairs<D>& pairs, const HatCells<D>& cells, Buffer<Vec<D, T>>& columns) {
  columns.resize(std::size_t{slots<D>} * pairs.fluidCount);
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(
      pairs, pairs.fluidList, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
        VecLanes<D> s, own = {}, sum[slots<D>] = {};
        for (std::uint32_t lane = 0; lane < clusterSize; ++lane) {
          const Vec<D>& xi = pairs.position[range.particle(lane)];
          const Vec<D, int> cell = cells.grid.cellOf(xi);
          const Vec<D> place = cells.fraction(xi, cell);
          const Vec<D, int> lowest = cells.lowestNode(cell, place);
          for (int k = 0; k < D; ++k) s[k][lane] = place[k] + cell[k] - lowest[k];
        }
        for (ListSegment segment : {ListSegment::NearFluid, ListSegment::NearWall})
          for (std::uint32_t j : pairs.fluidList.segment(c, segment)) {
            const PairLanes<D> pair(pairs, j, x, floor2);
            const Lanes g = pairs.terms.gradient(pair.r);
            VecLanes<D> gd, other;
            for (int k = 0; k < D; ++k) {
              own[k] += gd[k] = g * pair.d[k];
              other[k] = s[k] + pair.d[k] * pairs.grid.inverseEdge[k];
            }
            addHats<D>(other, Renormalised ? corrected(pairs, j, gd) : gd, sum);
          }
        if constexpr (Renormalised) {
          const SymmetricBlock<D, Lanes> b = loadBlocks<Lanes>(range, pairs.renormalisation);
          const VecLanes<D> plain = own;
          for (int k = 0; k < D; ++k) own[k] = b.row(k, plain);
        }
        addHats<D>(s, own, sum);
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          for (int n = 0; n < slots<D>; ++n)
            for (int k = 0; k < D; ++k)
              columns[(range.first + lane) * std::size_t{slots<D>} + n][k] = static_cast<T>(sum[n][k][lane]);
      });
}

/// Where in a row of the matrix the nodes stand that are up to two steps away per axis; on short periodic axes
/// several steps lead to the same one.
template <int D>
class RowEntries {
 public:
  static constexpr int offsets = D == 2 ? 25 : 125;
  static constexpr std::uint64_t none = ~std::uint64_t{0};

  RowEntries(const HatNodes<D>& nodes, const BlockCsr<1>& s, std::size_t row, const Vec<D, int>& node) {
    const std::uint32_t *begin = &s.column[s.rowStart[row]],
                        *end = begin + (s.rowStart[row + 1] - s.rowStart[row]);
    for (int o = 0; o < offsets; ++o) {
      Vec<D, int> other = node;
      bool inside = true;
      for (int k = 0, digits = o; k < D; ++k, digits /= 5) {
        const int n = nodes.lattice.count[k];
        other[k] += digits % 5 - 2;
        if (nodes.lattice.periodic[k])
          other[k] = (other[k] + n) % n;
        else
          inside = inside && other[k] >= 0 && other[k] < n;
      }
      const std::uint32_t* place = inside ? std::find(begin, end, nodes.nodeAt[nodes.lattice.linear(other)]) : end;
      entry_[o] = place == end ? none : s.rowStart[row] + (place - begin);
    }
  }
  std::uint64_t operator[](int offset) const { return entry_[offset]; }

  /// The offset from one slot of a particle (base 3) to another.
  static constexpr int between(int from, int to) {
    int offset = 0, step = 1;
    for (int k = 0; k < D; ++k, from /= 3, to /= 3, step *= 5) offset += step * (to % 3 - from % 3 + 2);
    return offset;
  }

 private:
  std::array<std::uint64_t, offsets> entry_;
};

/// Offset from slot 0 to each slot.
template <int D>
constexpr auto offsetOfSlot = [] {
  std::array<int, slots<D>> offset{};
  for (int slot = 0; slot < slots<D>; ++slot)
    offset[slot] = RowEntries<D>::between(0, slot) - RowEntries<D>::between(0, 0);
  return offset;
}();

/// A corner of a cell among the 3^D nodes from the cell's lowest one on.
template <int D>
int slotOfCorner(int corner) {
  int slot = 0, step = 1;
  for (int k = 0; k < D; ++k, step *= 3) slot += step * (corner >> k & 1);
  return slot;
}

}  // namespace

template <int D, class T>
void pressureGalerkin(Context<Cpu>& context, const MphPairs<D>& pairs, const ProjectionTable<double>& table,
                      const HatNodes<D>& nodes, Buffer<Vec<D, T>>& columns, BlockCsr<1>& s) {
  const HatCells<D> cells{pairs.grid};
  withRenormalisation(pairs, [&]<bool Renormalised>() { pressureColumns<Renormalised>(pairs, cells, columns); });
  hatPattern(context, nodes, s);
  parallelFor(nodes.count(), parallelGrain / 16, [&](std::size_t row) {
    const Vec<D, int> node = nodes.lattice.at(nodes.point[row]);
    const RowEntries<D> entryAt(nodes, s, row, node);
    std::array<double, RowEntries<D>::offsets> sum{};
    cells.forEachCellAround(node, 2, [&](const Vec<D, int>& cell) {
      pairs.forEachOwnFluid(pairs.grid.linear(cell), [&](std::uint32_t i) {
        const Vec<D, int> lowest = cells.lowestNode(cell, cells.fraction(pairs.position[i], cell));
        const int own = cells.slot(node, lowest);
        if (own < 0) return;
        const Vec<D, T>* column = &columns[std::size_t{slots<D>} * i];
        const Vec<D> weighted = table.weight[pairs.classOf()[i]] * toDouble(column[own]);
        const int from = RowEntries<D>::between(own, 0);
        for (int other = 0; other < slots<D>; ++other)
          sum[from + offsetOfSlot<D>[other]] += fixedDot(weighted, toDouble(column[other]));
      });
    });
    cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
      forEachParticle(pairs, cell, [&](std::uint32_t k) {
        const Vec<D> place = cells.fraction(pairs.position[k], cell);
        const double w = table.shiftOf(k, pairs.classOf()[k]) * cells.hat(node, cell, place);
        int own = 0, step = 1;  // corner of the cell that is the node, as a slot
        for (int axis = 0; axis < D; ++axis, step *= 3) own += step * cells.above(node[axis], cell[axis], axis);
        forEachCorner(place, [&](int corner, double hat) {
          sum[RowEntries<D>::between(own, slotOfCorner<D>(corner))] += w * hat;
        });
      });
    });
    for (std::uint64_t e = s.rowStart[row]; e < s.rowStart[row + 1]; ++e) s.value[e].a[0] = 0;
    for (int o = 0; o < RowEntries<D>::offsets; ++o)
      if (entryAt[o] != RowEntries<D>::none) s.value[entryAt[o]].a[0] += sum[o];
  });
  sumRows<D>(context, nodes, hatReach, s);
}

#define TREACLE_INSTANTIATE(D, T)                                                                         \
  template void pressureGalerkin<D, T>(Context<Cpu>&, const MphPairs<D>&, const ProjectionTable<double>&, \
                                       const HatNodes<D>&, Buffer<Vec<D, T>>&, BlockCsr<1>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
