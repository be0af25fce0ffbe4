#pragma once

#include "starting_part.hpp"
#include "treacle/precondition/hat_cells.hpp"
#include "treacle/precondition/hat_grid.hpp"
#include "treacle/step/solve_stages.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace treacle {

/// Counts the background grids of a preconditioner, as HatMultigrid makes and divides them.
template <int D>
class GridCounts {
 public:
  /// Arguments must outlive it.
  GridCounts(const Case& c, const SortedParticles<D>& particles, StartingPart<D>& part)
      : part_(part),
        particles_(particles),
        mostWhole_(part.owners() ? static_cast<std::uint64_t>(c.solver.dividedNodes) : anyNumber) {
    particles_.cells = viewOf(part.rangesOfAll());
  }

  /// Down to the smallest level that a backend may take; `numbers` per node. Collective where processes share.
  std::vector<MemoryCounts::Grid> levels(HatsOn what, int reach, int numbers) const {
    Context<Cpu>& context = part_.context();
    const std::uint64_t mostWhole = std::max<std::uint64_t>(mostWhole_, leastUnknowns / numbers);
    HatNodes<D> nodes;  // of all processes
    findHatNodes(context, particles_, what, nodes);
    std::optional<Division> division;
    if (nodes.count() > mostWhole) division = divided(nodes, ownersOfNodes(nodes.lattice), nullptr);
    std::vector<MemoryCounts::Grid> levels;
    while (true) {
      levels.push_back(count(nodes, division ? &*division : nullptr, reach));
      if (static_cast<std::uint32_t>(numbers) * nodes.count() <= leastUnknowns) return levels;
      HatNodes<D> coarse;
      coarserNodes<D>(context, nodes, coarse);
      // As HatMultigrid does.
      if (static_cast<std::uint32_t>(numbers) * coarse.count() > leastUnknowns &&
          coarse.count() > 0.9 * nodes.count())
        return levels;
      if (division && coarse.count() > mostWhole)
        division = divided(coarse, ownersBelow(nodes.lattice, *division, coarse.lattice), &*division);
      else
        division.reset();
      nodes = std::move(coarse);
    }
  }

 private:
  static constexpr std::uint32_t leastUnknowns = 200;

  /// What divideNodes finds for the process.
  struct Division {
    HatLattice<D> lattice;
    Buffer<std::int32_t> owner;  // per lattice point
    Buffer<std::uint8_t> has;    // per lattice point: a node of its own, or a ghost
    std::uint64_t own = 0;
  };

  Buffer<std::int32_t> ownersOfNodes(const HatLattice<D>& lattice) const {
    const HatCells<D> cells{particles_.grid};
    Buffer<std::int32_t> owner(lattice.points());
    for (std::size_t p = 0; p < owner.size(); ++p) owner[p] = part_.owners()[cells.cellOfNode(lattice.at(p))];
    return owner;
  }
  static Buffer<std::int32_t> ownersBelow(const HatLattice<D>& fine, const Division& division,
                                          const HatLattice<D>& lattice) {
    Buffer<std::int32_t> owner(lattice.points());
    for (std::size_t p = 0; p < owner.size(); ++p) owner[p] = division.owner[pointBelow(fine, lattice.at(p))];
    return owner;
  }

  /// `finer`: of the nodes of half the edge; null for the finest.
  Division divided(const HatNodes<D>& nodes, Buffer<std::int32_t> owner, const Division* finer) const {
    const std::size_t points = nodes.lattice.points();
    Buffer<std::uint8_t> active(points);
    for (std::size_t p = 0; p < points; ++p) active[p] = nodes.nodeAt[p] != noNode;
    const DividedLattice<D> lattice{nodes.lattice, owner.data(), active.data(), part_.rank()};
    Division division;
    division.has.resize(points);
    for (std::size_t p = 0; p < points; ++p) {
      bool carried = false;
      if (finer)
        forEachFine(finer->lattice, nodes.lattice.at(p), [&](const Vec<D, int>& q, double) {
          carried = carried || finer->has[finer->lattice.linear(q)] != 0;
        });
      const NodePlace place = nodePlace(lattice, p, carried);
      division.has[p] = place != NodePlace::None;
      division.own += place == NodePlace::Own;
    }
    division.lattice = nodes.lattice;
    division.owner = std::move(owner);
    return division;
  }

  MemoryCounts::Grid count(const HatNodes<D>& nodes, const Division* division, int reach) const {
    const auto counted = [&](const HatNodes<D>& held) {
      BlockCsr<1> a;
      hatPattern(part_.context(), held, a, reach);
      return MemoryCounts::Grid{held.count(), held.nodeAt.size(), a.column.size()};
    };
    if (!division) return counted(nodes);
    HatNodes<D> held;
    numberNodes<D>(part_.context(), nodes.lattice, division->has, held);
    MemoryCounts::Grid grid = counted(held);
    grid.divided = true;
    grid.ghosts = held.count() - division->own;
    return grid;
  }

  StartingPart<D>& part_;
  SortedParticles<D> particles_;
  std::uint64_t mostWhole_;
};

}  // namespace treacle
