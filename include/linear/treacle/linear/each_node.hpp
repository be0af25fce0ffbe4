#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/linear/hat_nodes.hpp"

#include <utility>

namespace treacle {

// What is found out about each lattice point by itself, for the sources of both backends, which instantiate it. A
// thread of a device has one point; there are no atomics.

/// number[p] = so many flags before p are not zero. Returns how many are.
template <class Backend>
std::uint32_t numbersOf(Context<Backend>& context, std::span<const std::uint8_t> flags,
                        Buffer<std::uint32_t, Backend>& number) {
  number.resize(context, flags.size() + 1);
  std::uint32_t* const n = number.data();
  forEach(context, flags.size(), [=] TREACLE_HD(std::size_t p) { n[p] = flags[p] != 0; });
  return startRows(context, number);
}

template <class Backend>
std::uint32_t countNodes(Context<Backend>& context, std::span<const std::uint8_t> active) {
  Buffer<std::uint32_t, Backend> number;
  return numbersOf(context, active, number);
}

template <int D, class Backend>
void numberNodes(Context<Backend>& context, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D, Backend>& nodes) {
  Buffer<std::uint32_t, Backend> number;
  const std::uint32_t count = numbersOf(context, active, number);
  nodes.lattice = lattice;
  nodes.division.reset();
  nodes.nodeAt.resize(context, active.size());
  nodes.point.resize(context, count);
  std::uint32_t *const n = number.data(), *const at = nodes.nodeAt.data(), *const point = nodes.point.data();
  forEach(context, active.size(), [=] TREACLE_HD(std::size_t p) {
    at[p] = active[p] ? n[p] : noNode;
    if (active[p]) point[n[p]] = static_cast<std::uint32_t>(p);
  });
}

template <int D, class Backend>
void coarserNodes(Context<Backend>& context, const HatNodes<D, Backend>& fine, HatNodes<D, Backend>& coarse,
                  std::uint64_t mostWhole) {
  const HatLattice<D> lattice = fine.lattice.coarser();
  const HatNodesView<D> view = fine.view();
  const std::size_t points = lattice.points(), divided = fine.division ? points : 0;
  Buffer<std::uint8_t, Backend> active(context, points), carried(context, divided);
  Buffer<std::int32_t, Backend> owner(context, divided);
  const std::int32_t* const fineOwner = fine.division ? fine.division->owner.data() : nullptr;
  const std::span<std::uint8_t> isActive = active, isCarried = carried;
  const std::span<std::int32_t> ownerOf = owner;
  forEach(context, points, [=] TREACLE_HD(std::size_t p) {
    const Vec<D, int> point = lattice.at(p);
    bool any = false, mine = false;
    forEachFine(view.lattice, point, [&](const Vec<D, int>& q, double) {
      any = any || view.isNode(q);
      mine = mine || view.at(q) != noNode;
    });
    isActive[p] = any;
    if (!fineOwner) return;
    isCarried[p] = mine;
    ownerOf[p] = fineOwner[pointBelow(view.lattice, point)];
  });
  if (!fine.division || countNodes<Backend>(context, active) <= mostWhole)
    return numberNodes<D>(context, lattice, active, coarse);
  divideNodes<D>(context, lattice, std::move(owner), std::move(active), carried, coarse);
}

}  // namespace treacle
