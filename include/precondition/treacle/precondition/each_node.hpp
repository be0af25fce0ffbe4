#pragma once

#include "treacle/core/device_link.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/precondition/hat_cells.hpp"
#include "treacle/precondition/hat_grid.hpp"

#include <utility>

namespace treacle {

/// For the sources of both backends. A thread of a device has one lattice point; there are no atomics.
template <int D, class Backend>
void findHatNodes(Context<Backend>& context, const SortedParticles<D>& pairs, HatsOn what,
                  HatNodes<D, Backend>& nodes, std::uint64_t mostWhole) {
  const HatCells<D> cells{pairs.grid};
  HatLattice<D> lattice;
  for (int k = 0; k < D; ++k) lattice.count[k] = cells.nodesOn(k);
  lattice.periodic = pairs.grid.periodic;
  Buffer<std::uint8_t, Backend> active(context, lattice.points());
  const std::span<std::uint8_t> isActive = active;
  const CellRangesView ranges = pairs.cells;
  forEach(context, lattice.points(), [=] TREACLE_HD(std::size_t p) {
    bool any = false;
    cells.forEachCellAround(lattice.at(p), 1, [&](const Vec<D, int>& cell) {
      const std::size_t c = cells.grid.linear(cell);
      any = any || ranges.fluidEnd[c] > ranges.fluidBegin[c] ||
            (what == HatsOn::Active && ranges.wallEnd[c] > ranges.wallBegin[c]);
    });
    isActive[p] = any;
  });
  anyOverSharing(context, active.span());
  if (!context.communicator || countNodes<Backend>(context, active) <= mostWhole)
    return numberNodes<D>(context, lattice, active, nodes);
  Buffer<std::int32_t, Backend> owner(context, lattice.points());
  const std::span<std::int32_t> ownerOf = owner;
  const std::int32_t* const ofCell = pairs.owner;
  forEach(context, owner.size(),
          [=] TREACLE_HD(std::size_t p) { ownerOf[p] = ofCell[cells.cellOfNode(lattice.at(p))]; });
  divideNodes<D>(context, lattice, std::move(owner), std::move(active), {}, nodes);
}

}  // namespace treacle
