#include "hat_loops.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_neighbours.hpp"
#include "treacle/precondition/hat_grid.hpp"

#include <algorithm>
#include <array>

namespace treacle {
namespace {

template <int D>
constexpr int slots = D == 2 ? 9 : 27;  // nodes that the neighbours of a particle touch

/// (C P)_in of each fluid particle i for the 3^D nodes n around it.
template <bool Renormalised, int D, class T>
void pressureColumns(const MphPairs<D>& pairs, const HatCells<D>& cells, Buffer<Vec<D, T>>& columns) {
  columns.resize(std::size_t{slots<D>} * pairs.fluidCount);
  const auto addHats = [&](const Vec<D>& s, const Vec<D>& g, std::array<Vec<D>, slots<D>>& sum) {
    double hat[D][3];
    for (int k = 0; k < D; ++k)
      for (int n = 0; n < 3; ++n) hat[k][n] = std::max(0.0, 1 - std::abs(s[k] - n));
    for (int n = 0; n < slots<D>; ++n) {
      double weight = 1;
      for (int k = 0, digits = n; k < D; ++k, digits /= 3) weight *= hat[k][digits % 3];
      sum[n] += weight * g;
    }
  };
  parallelFor(pairs.fluidCount, parallelGrain, [&](std::size_t index) {
    const auto i = static_cast<std::uint32_t>(index);
    const Vec<D> x = pairs.position[i];
    const Vec<D, int> cell = cells.grid.cellOf(x);
    const Vec<D> place = cells.fraction(x, cell);
    const Vec<D, int> lowest = cells.lowestNode(cell, place);
    Vec<D> s, own{};
    for (int k = 0; k < D; ++k) s[k] = place[k] + cell[k] - lowest[k];
    std::array<Vec<D>, slots<D>> sum{};
    for (ListSegment segment : {ListSegment::NearFluid, ListSegment::NearWall})
      forEachEntry(pairs, i, segment, [&](std::uint32_t j, const Vec<D>& d) {
        const double r2 = fixedDot(d, d), h = pairs.terms.pressureRadius;
        if (j == i || r2 >= h * h || r2 == 0) return;
        const Vec<D> g = pairs.terms.gradient(ExactDistance(r2)) * d;
        own += g;
        Vec<D> other;
        for (int k = 0; k < D; ++k) other[k] = s[k] + d[k] * pairs.grid.inverseEdge[k];
        addHats(other, Renormalised ? pairs.corrected(j, g) : g, sum);
      });
    addHats(s, Renormalised ? pairs.corrected(i, own) : own, sum);
    for (int n = 0; n < slots<D>; ++n)
      for (int k = 0; k < D; ++k) columns[index * slots<D> + n][k] = static_cast<T>(sum[n][k]);
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
      const std::size_t c = pairs.grid.linear(cell);
      for (std::uint32_t i = pairs.cells.fluidBegin[c]; i < pairs.cells.fluidEnd[c]; ++i) {
        const Vec<D, int> lowest = cells.lowestNode(cell, cells.fraction(pairs.position[i], cell));
        const int own = cells.slot(node, lowest);
        if (own < 0) continue;
        const Vec<D, T>* column = &columns[std::size_t{slots<D>} * i];
        const Vec<D> weighted = table.weight[pairs.material[i]] * toDouble(column[own]);
        const int from = RowEntries<D>::between(own, 0);
        for (int other = 0; other < slots<D>; ++other)
          sum[from + offsetOfSlot<D>[other]] += fixedDot(weighted, toDouble(column[other]));
      }
    });
    cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
      forEachParticle(pairs, cell, [&](std::uint32_t k) {
        const Vec<D> place = cells.fraction(pairs.position[k], cell);
        const double w = table.shift[pairs.material[k]] * cells.hat(node, cell, place);
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
