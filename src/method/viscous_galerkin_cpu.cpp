#include "hat_loops.hpp"
#include "pair_lanes.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/method/hat_grid.hpp"

namespace treacle {
namespace {

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

}  // namespace

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

#define TREACLE_INSTANTIATE(D, T)                                                                                 \
  template void viscousGalerkin<D, T>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, const HatNodes<D>&, \
                                      Buffer<ViscousMoments<D, T>>&, BlockCsr<D>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
