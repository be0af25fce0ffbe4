#include "treacle/core/each.hpp"
#include "treacle/linear/each_node.hpp"

#include <algorithm>
#include <utility>

namespace treacle {

template <int D, int B, class Backend>
void hatPattern(Context<Backend>&, const HatNodes<D, Backend>& nodes, BlockCsr<B, double, Backend>& a, int reach) {
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

template <int D, int B, class Backend>
void coarsenHats(Context<Backend>& context, const HatNodes<D, Backend>& fine,
                 const BlockCsr<B, double, Backend>& a, const HatNodes<D, Backend>& coarse,
                 BlockCsr<B, double, Backend>& coarseA, int reach) {
  hatPattern<D>(context, coarse, coarseA, reach);
  const HatNodesView<D> fineView = fine.view(), coarseView = coarse.view();
  parallelFor(coarse.count(), 16, [&](std::size_t row) {
    coarseRow<D>(fineView, a, coarseView, static_cast<std::uint32_t>(row), reach, coarseA);
  });
  if (fine.division) sumRows<D>(context, coarse, reach, coarseA);
}

template std::uint32_t countNodes(Context<Cpu>&, std::span<const std::uint8_t>);
TREACLE_HAT_NODES(2, Cpu)
TREACLE_HAT_NODES(3, Cpu)

}  // namespace treacle
