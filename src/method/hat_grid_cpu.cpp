#include "treacle/method/hat_grid.hpp"

#include "pair_lanes.hpp"
#include "pair_scalar.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/method/hat_cells.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace treacle {
namespace {

template <int D>
constexpr int slots = D == 2 ? 9 : 27;  // nodes that the neighbours of a particle touch

/// Calls f(k) for the active particles of a cell, fluid and walls.
template <int D, class F>
void forEachParticle(const MphPairs<D>& pairs, const Vec<D, int>& cell, F&& f) {
  const std::size_t c = pairs.grid.linear(cell);
  for (std::uint32_t k = pairs.cells.fluidBegin[c]; k < pairs.cells.fluidEnd[c]; ++k) f(k);
  for (std::uint32_t k = pairs.cells.wallBegin[c]; k < pairs.cells.wallEnd[c]; ++k) f(k);
}

/// (C P)_in of each fluid particle i for the 3^D nodes n around it.
template <int D, class T>
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
      forEachEntry(pairs, i, segment, [&](ListEntry e, const Vec<D>& d) {
        const double r2 = norm2(d), h = pairs.pressureWeight.radius;
        if (e.index() == i || r2 >= h * h || r2 == 0) return;
        const Vec<D> g = pairs.pressure.factor * (1 / std::sqrt(r2) - pairs.pressure.inverseRadius) * d;
        own += g;
        Vec<D> other;
        for (int k = 0; k < D; ++k) other[k] = s[k] + d[k] * pairs.grid.inverseEdge[k];
        addHats(other, g, sum);
      });
    addHats(s, own, sum);
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

/// Calls f(corner, weight) for the corners of a cell at a place in it; bit k of `corner`: the upper one of axis k.
template <int D, class T, class F>
void forEachCorner(const Vec<D, T>& place, F&& f) {
  for (int o = 0; o < 1 << D; ++o) {
    T weight = 1;
    for (int k = 0; k < D; ++k) weight *= o >> k & 1 ? place[k] : 1 - place[k];
    f(o, weight);
  }
}

/// A corner of a cell among the 3^D nodes from the cell's lowest one on.
template <int D>
int slotOfCorner(int corner) {
  int slot = 0, step = 1;
  for (int k = 0; k < D; ++k, step *= 3) slot += step * (corner >> k & 1);
  return slot;
}

template <int D, class T>
Vec<D> toDouble(const Vec<D, T>& v) {
  Vec<D> r;
  for (int k = 0; k < D; ++k) r[k] = v[k];
  return r;
}
template <int D, class T>
ViscousMoments<D, double> toDouble(const ViscousMoments<D, T>& v) {
  ViscousMoments<D, double> r;
  for (int k = 0; k < momentCount<D>; ++k) r.m[k] = v.m[k];
  return r;
}

template <int D, class T>
void viscousMoments(const MphPairs<D>& pairs, Buffer<ViscousMoments<D, T>>& moments) {
  moments.resize(pairs.fluidCount);
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, pairs.fluidList, [&](const ClusterRange& range, const VecLanes<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    Lanes sum[momentCount<D>] = {};
    for (ListSegment segment : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (ListEntry e : pairs.fluidList.segment(c, segment)) {
        const PairLanes<D> pair(pairs.positionOf(e), x, floor2);
        const Lanes f = 0.5 * viscousGalerkinFactor * viscosity.ofMaterial[pairs.material[e.index()]] *
                        pair.reach(pairs.viscosity) * pair.inverseR * pair.inverseR;
        forEachMoment<D>(pair.d, [&](int m, const Lanes& product) { sum[m] += f * product; });
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      for (int m = 0; m < momentCount<D>; ++m) moments[range.first + lane].m[m] = static_cast<T>(sum[m][lane]);
  });
}

}  // namespace

template <int D>
void findHatNodes(Context<Cpu>& context, const MphPairs<D>& pairs, HatsOn what, HatNodes<D>& nodes) {
  const HatCells<D> cells{pairs.grid};
  HatLattice<D> lattice;
  for (int k = 0; k < D; ++k) lattice.count[k] = cells.nodesOn(k);
  lattice.periodic = pairs.grid.periodic;
  std::vector<std::uint8_t> active(lattice.points());
  for (std::size_t p = 0; p < active.size(); ++p)
    cells.forEachCellAround(lattice.at(p), 1, [&](const Vec<D, int>& cell) {
      const std::size_t c = pairs.grid.linear(cell);
      active[p] |= pairs.cells.fluidEnd[c] > pairs.cells.fluidBegin[c] ||
                   (what == HatsOn::Active && pairs.cells.wallEnd[c] > pairs.cells.wallBegin[c]);
    });
  numberNodes(context, lattice, active, nodes);
}

template <int D, class T>
void pressureGalerkin(Context<Cpu>& context, const MphPairs<D>& pairs, const ProjectionTable<double>& table,
                      const HatNodes<D>& nodes, Buffer<Vec<D, T>>& columns, BlockCsr<1>& s) {
  const HatCells<D> cells{pairs.grid};
  pressureColumns(pairs, cells, columns);
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
          sum[from + offsetOfSlot<D>[other]] += dot(weighted, toDouble(column[other]));
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
    for (std::uint64_t e = s.rowStart[row]; e < s.rowStart[row + 1]; ++e) s.block[e].a[0] = 0;
    for (int o = 0; o < RowEntries<D>::offsets; ++o)
      if (entryAt[o] != RowEntries<D>::none) s.block[entryAt[o]].a[0] += sum[o];
  });
}

/// Blocks below the diagonal from those above.
template <int D>
void mirrorUpper(BlockCsr<D>& a) {
  parallelFor(a.rows(), parallelGrain, [&](std::size_t row) {
    for (std::uint64_t e = a.rowStart[row]; e < a.rowStart[row + 1]; ++e) {
      const std::size_t other = a.column[e];
      if (other >= row) continue;
      const std::uint32_t *begin = &a.column[a.rowStart[other]],
                          *end = begin + (a.rowStart[other + 1] - a.rowStart[other]);
      const Block<D>& above = a.block[a.rowStart[other] + (std::find(begin, end, row) - begin)];
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) a.block[e](r, c) = above(c, r);
    }
  });
}

template <int D, class T>
void viscousGalerkin(Context<Cpu>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                     const HatNodes<D>& nodes, Buffer<ViscousMoments<D, T>>& moments, BlockCsr<D>& a) {
  const HatCells<D> cells{pairs.grid};
  viscousMoments(pairs, moments);
  hatPattern(context, nodes, a, 1);
  parallelFor(nodes.count(), parallelGrain / 16, [&](std::size_t row) {
    const Vec<D, int> node = nodes.lattice.at(nodes.point[row]);
    for (std::uint64_t e = a.rowStart[row]; e < a.rowStart[row + 1]; ++e) {
      if (a.column[e] < row) continue;
      const Vec<D, int> other = nodes.lattice.at(nodes.point[a.column[e]]);
      Block<D> sum{};
      cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
        if (!cells.isCorner(other, cell)) return;
        const std::size_t c = pairs.grid.linear(cell);
        for (std::uint32_t i = pairs.cells.fluidBegin[c]; i < pairs.cells.fluidEnd[c]; ++i) {
          const Vec<D> place = cells.fraction(pairs.position[i], cell);
          double own, others;
          Vec<D> p, q;
          cells.cornerHat(node, cell, place, own, p);
          cells.cornerHat(other, cell, place, others, q);
          sum += toDouble(moments[i]).between(p, q);
          for (int k = 0; k < D * D; ++k) sum.a[k] += own * others * terms.block[i].a[k];
        }
      });
      a.block[e] = sum;
    }
  });
  mirrorUpper(a);
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::prepare(Context<Cpu>&, const MphPairs<D>& pairs) {
  pairs_ = &pairs;
  corner_.resize(std::size_t{corners} * pairs.activeCount);
  place_.resize(pairs.activeCount);
  const HatCells<D> cells{pairs.grid};
  HatLattice<D> lattice;
  for (int k = 0; k < D; ++k) lattice.count[k] = cells.nodesOn(k);
  parallelFor(pairs.activeCount, parallelGrain, [&](std::size_t i) {
    const Vec<D, int> cell = cells.grid.cellOf(pairs.position[i]);
    const Vec<D> place = cells.fraction(pairs.position[i], cell);
    for (int k = 0; k < D; ++k) place_[i][k] = static_cast<T>(place[k]);
    for (int o = 0; o < corners; ++o) {
      Vec<D, int> node = cell;
      for (int k = 0; k < D; ++k)
        if ((o >> k & 1) && ++node[k] == lattice.count[k]) node[k] = 0;  // only on periodic axes
      corner_[corners * i + o] = static_cast<std::uint32_t>(lattice.linear(node));
    }
  });
}

/// b of each node from the particles of the cells around it: add(sums, particle, weight).
template <int D, class T, class F, class Add>
void gatherAtNodes(const MphPairs<D>& pairs, const HatNodes<D>& nodes, const Buffer<Vec<D, T>>& place,
                   F&& forEachIn, Add&& add) {
  const HatCells<D> cells{pairs.grid};
  parallelFor(nodes.count(), parallelGrain, [&](std::size_t n) {
    const Vec<D, int> node = nodes.lattice.at(nodes.point[n]);
    cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
      bool upper[D];
      for (int k = 0; k < D; ++k) upper[k] = cells.above(node[k], cell[k], k) == 1;
      forEachIn(cell, [&](std::uint32_t i) {
        T weight = 1;
        for (int k = 0; k < D; ++k) weight *= upper[k] ? place[i][k] : 1 - place[i][k];
        add(n, i, weight);
      });
    });
  });
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::restrict(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> r,
                                      std::span<T> b) const {
  std::fill(b.begin(), b.end(), T(0));
  gatherAtNodes(
      *pairs_, nodes, place_, [&](const Vec<D, int>& cell, auto&& f) { forEachParticle(*pairs_, cell, f); },
      [&](std::size_t n, std::uint32_t i, T weight) { b[n] += weight * r[i]; });
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::restrict(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const Gathered<D, T>> r,
                                      std::span<T> b) const {
  std::fill(b.begin(), b.end(), T(0));
  const auto forEachFluid = [&](const Vec<D, int>& cell, auto&& f) {
    const std::size_t c = pairs_->grid.linear(cell);
    for (std::uint32_t i = pairs_->cells.fluidBegin[c]; i < pairs_->cells.fluidEnd[c]; ++i) f(i);
  };
  gatherAtNodes(*pairs_, nodes, place_, forEachFluid, [&](std::size_t n, std::uint32_t i, T weight) {
    for (int k = 0; k < D; ++k) b[n * D + k] += weight * r[i][k];
  });
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::prolong(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e,
                                     ScalarField<T, Cpu> z, std::span<T> x) const {
  parallelFor(pairs_->activeCount, parallelGrain, [&](std::size_t i) {
    T sum = 0;
    forEachCorner(place_[i], [&](int o, T weight) { sum += weight * e[nodes.nodeAt[corner_[corners * i + o]]]; });
    z[i] = sum;
    x[i] += sum;
  });
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::prolong(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e,
                                     std::span<Gathered<D, T>> z, std::span<Gathered<D, T>> x) const {
  parallelFor(pairs_->fluidCount, parallelGrain, [&](std::size_t i) {
    Vec<D, T> sum{};
    forEachCorner(place_[i], [&](int o, T weight) {
      const T* node = &e[std::size_t{D} * nodes.nodeAt[corner_[corners * i + o]]];
      for (int k = 0; k < D; ++k) sum[k] += weight * node[k];
    });
    z[i] = sum;
    x[i] += sum;
  });
}

#define TREACLE_INSTANTIATE(D, T)                                                                                 \
  template void pressureGalerkin<D, T>(Context<Cpu>&, const MphPairs<D>&, const ProjectionTable<double>&,         \
                                       const HatNodes<D>&, Buffer<Vec<D, T>>&, BlockCsr<1>&);                     \
  template void viscousGalerkin<D, T>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, const HatNodes<D>&, \
                                      Buffer<ViscousMoments<D, T>>&, BlockCsr<D>&);                               \
  template class HatTransfer<D, T, Cpu>;
template void findHatNodes<2>(Context<Cpu>&, const MphPairs<2>&, HatsOn, HatNodes<2>&);
template void findHatNodes<3>(Context<Cpu>&, const MphPairs<3>&, HatsOn, HatNodes<3>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
