#include "hat_loops.hpp"
#include "treacle/core/each.hpp"
#include "treacle/precondition/each_node.hpp"

#include <algorithm>

namespace treacle {

template <int D, class T>
void HatTransfer<D, T, Cpu>::prepare(Context<Cpu>&, const SortedParticles<D>& pairs) {
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
void gatherAtNodes(const SortedParticles<D>& pairs, const HatNodes<D>& nodes, const Buffer<Vec<D, T>>& place,
                   F&& forEachIn, Add&& add) {
  const HatCells<D> cells{pairs.grid};
  parallelFor(nodes.count(), parallelGrain / 8, [&](std::size_t n) {
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
void HatTransfer<D, T, Cpu>::restrict(Context<Cpu>& context, const HatNodes<D>& nodes, std::span<const T> r,
                                      std::span<T> b) const {
  std::fill(b.begin(), b.end(), T(0));
  gatherAtNodes(
      *pairs_, nodes, place_, [&](const Vec<D, int>& cell, auto&& f) { forEachParticle(*pairs_, cell, f); },
      [&](std::size_t n, std::uint32_t i, T weight) { b[n] += weight * r[i]; });
  sumAtNodes<1>(context, nodes, b);
}

template <int D, class T>
void HatTransfer<D, T, Cpu>::restrict(Context<Cpu>& context, const HatNodes<D>& nodes,
                                      std::span<const Gathered<D, T>> r, std::span<T> b) const {
  std::fill(b.begin(), b.end(), T(0));
  const auto forEachFluid = [&](const Vec<D, int>& cell, auto&& f) {
    pairs_->forEachOwnFluid(pairs_->grid.linear(cell), f);
  };
  gatherAtNodes(*pairs_, nodes, place_, forEachFluid, [&](std::size_t n, std::uint32_t i, T weight) {
    for (int k = 0; k < D; ++k) b[n * D + k] += weight * r[i][k];
  });
  sumAtNodes<D>(context, nodes, b);
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
void HatTransfer<D, T, Cpu>::addProlonged(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e,
                                          std::span<T> x) const {
  parallelFor(pairs_->activeCount, parallelGrain, [&](std::size_t i) {
    forEachCorner(place_[i], [&](int o, T weight) { x[i] += weight * e[nodes.nodeAt[corner_[corners * i + o]]]; });
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

template void findHatNodes(Context<Cpu>&, const SortedParticles<2>&, HatsOn, HatNodes<2, Cpu>&, std::uint64_t);
template void findHatNodes(Context<Cpu>&, const SortedParticles<3>&, HatsOn, HatNodes<3, Cpu>&, std::uint64_t);
template class HatTransfer<2, double, Cpu>;
template class HatTransfer<3, double, Cpu>;
template class HatTransfer<2, float, Cpu>;
template class HatTransfer<3, float, Cpu>;

}  // namespace treacle
