#include "treacle/linear/hat_nodes.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <utility>

namespace treacle {

std::uint32_t countNodes(Context<Cpu>&, std::span<const std::uint8_t> active) {
  return static_cast<std::uint32_t>(active.size() - std::count(active.begin(), active.end(), std::uint8_t{0}));
}

template <int D>
void numberNodes(Context<Cpu>& context, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D>& nodes) {
  nodes.lattice = lattice;
  nodes.division.reset();
  nodes.nodeAt.resize(active.size());
  nodes.point.resize(countNodes(context, active));
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < active.size(); ++p) {
    nodes.nodeAt[p] = active[p] ? count : noNode;
    if (active[p]) nodes.point[count++] = static_cast<std::uint32_t>(p);
  }
}

template <int D>
void coarserNodes(Context<Cpu>& context, const HatNodes<D>& fine, HatNodes<D>& coarse, std::uint64_t mostWhole) {
  const HatLattice<D> lattice = fine.lattice.coarser();
  const HatNodesView<D> view = fine.view();
  Buffer<std::uint8_t> active(lattice.points()), carried(fine.division ? lattice.points() : 0);
  Buffer<std::int32_t> owner(carried.size());
  parallelFor(active.size(), parallelGrain, [&](std::size_t p) {
    const Vec<D, int> point = lattice.at(p);
    bool any = false, mine = false;
    forEachFine(view.lattice, point, [&](const Vec<D, int>& q, double) {
      any = any || view.isNode(q);
      mine = mine || view.at(q) != noNode;
    });
    active[p] = any;
    if (!fine.division) return;
    carried[p] = mine;
    owner[p] = fine.division->owner[pointBelow(fine.lattice, point)];
  });
  if (!fine.division || countNodes(context, active) <= mostWhole)
    return numberNodes<D>(context, lattice, active, coarse);
  divideNodes<D>(context, lattice, std::move(owner), std::move(active), carried, coarse);
}

template <int D, int B>
void hatPattern(Context<Cpu>&, const HatNodes<D>& nodes, BlockCsr<B>& a, int reach) {
  const HatNodesView<D> view = nodes.view();
  const auto forEachColumn = [&](std::size_t i, auto&& f) {
    forEachNear(view.lattice, view.pointOf(i), reach, [&](const Vec<D, int>& p) {
      const std::uint32_t j = view.at(p);
      if (j != noNode) f(j);
    });
  };
  a.rowStart.resize(std::size_t{view.count} + 1);
  a.rowStart[0] = 0;
  parallelFor(view.count, parallelGrain / 8, [&](std::size_t i) {
    std::uint64_t count = 0;
    forEachColumn(i, [&](std::uint32_t) { ++count; });
    a.rowStart[i + 1] = count;
  });
  for (std::uint32_t i = 0; i < view.count; ++i) a.rowStart[i + 1] += a.rowStart[i];
  a.column.resize(a.rowStart[view.count]);
  a.value.resize(a.rowStart[view.count]);
  parallelFor(view.count, parallelGrain / 8, [&](std::size_t i) {
    std::uint64_t k = a.rowStart[i];
    forEachColumn(i, [&](std::uint32_t j) { a.column[k++] = j; });
  });
}

namespace {

/// sum += weight block
template <int B>
void addScaled(Block<B>& sum, double weight, const Block<B>& block) {
  for (int e = 0; e < B * B; ++e) sum.a[e] += weight * block.a[e];
}

/// One row of P^T A P: first P^T A by fine point around the coarse one, then the hats of each column summed over
/// it.
template <int D, int B>
void coarseRow(const HatNodesView<D>& fine, const BlockCsr<B>& a, const HatNodesView<D>& coarse, std::uint32_t row,
               int reach, BlockCsr<B>& coarseA) {
  const Vec<D, int> point = coarse.pointOf(row);
  const HatBox<D> box = HatBox<D>::around(fine.lattice, point * 2, reach + 1);
  Block<B> sums[hatGatherPlaces<D>(hatReach)];
  std::fill_n(sums, box.size(), Block<B>{});
  forEachFine(fine.lattice, point, [&](const Vec<D, int>& p, double weight) {
    const std::uint32_t i = fine.at(p);
    if (i >= fine.own) return;  // other processes have the rows of ghosts, and noNode is no row
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k) {
      const int place = box.placeOf(fine.pointOf(a.column[k]));
      if (place >= 0) addScaled(sums[place], weight, a.value[k]);
    }
  });
  for (std::uint64_t k = coarseA.rowStart[row]; k < coarseA.rowStart[row + 1]; ++k) {
    Block<B> sum{};
    forEachFine(fine.lattice, coarse.pointOf(coarseA.column[k]), [&](const Vec<D, int>& p, double weight) {
      const int place = box.placeOf(p);
      if (place >= 0) addScaled(sum, weight, sums[place]);
    });
    coarseA.value[k] = sum;
  }
}

}  // namespace

template <int D, int B>
void coarsenHats(Context<Cpu>& context, const HatNodes<D>& fine, const BlockCsr<B>& a, const HatNodes<D>& coarse,
                 BlockCsr<B>& coarseA, int reach) {
  hatPattern<D>(context, coarse, coarseA, reach);
  const HatNodesView<D> fineView = fine.view(), coarseView = coarse.view();
  parallelFor(coarse.count(), 16, [&](std::size_t row) {
    coarseRow<D>(fineView, a, coarseView, static_cast<std::uint32_t>(row), reach, coarseA);
  });
  if (fine.division) sumRows<D>(context, coarse, reach, coarseA);
}

#define TREACLE_INSTANTIATE(D)                                                                                    \
  template void numberNodes<D>(Context<Cpu>&, const HatLattice<D>&, std::span<const std::uint8_t>, HatNodes<D>&); \
  template void coarserNodes<D>(Context<Cpu>&, const HatNodes<D>&, HatNodes<D>&, std::uint64_t);
#define TREACLE_INSTANTIATE_MATRICES(D, B)                                                                   \
  template void hatPattern<D, B>(Context<Cpu>&, const HatNodes<D>&, BlockCsr<B>&, int);                      \
  template void coarsenHats<D, B>(Context<Cpu>&, const HatNodes<D>&, const BlockCsr<B>&, const HatNodes<D>&, \
                                  BlockCsr<B>&, int);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
TREACLE_INSTANTIATE_MATRICES(2, 1)
TREACLE_INSTANTIATE_MATRICES(2, 2)
TREACLE_INSTANTIATE_MATRICES(3, 1)
TREACLE_INSTANTIATE_MATRICES(3, 3)
#undef TREACLE_INSTANTIATE
#undef TREACLE_INSTANTIATE_MATRICES

}  // namespace treacle
