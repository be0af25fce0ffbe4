#pragma once

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/precondition/hat_cells.hpp"
#include "treacle/search/sorted_particles.hpp"

namespace treacle {

/// Numbers of the cells that have own particles, for what is kept of each of them. A cell is known by the node at
/// its lower corner.
struct OwnCellsView {
  const std::uint32_t* start;  // per node and behind: number of such cells before it; null: every node is one

  /// noNode for others.
  __device__ std::uint32_t at(std::uint32_t node) const {
    if (node == noNode || !start) return node;
    return start[node + 1] > start[node] ? start[node] : noNode;
  }
};

/// One thread per node: whether its cell has own particles. No atomics.
template <int D>
void markOwnCells(const Context<Cuda>& context, const SortedParticles<D>& particles, const HatNodesView<D>& nodes,
                  std::uint32_t* marks) {
  forEach(context, nodes.count,
          [grid = particles.grid, nodes, own = particles.ownRanges(), marks] __device__(std::size_t n) {
            const Vec<D, int> cell = nodes.pointOf(static_cast<std::uint32_t>(n));
            bool inside = true;  // the last nodes of an open axis are no lower corners
            for (int k = 0; k < D; ++k) inside = inside && cell[k] < grid.count[k];
            const std::size_t c = inside ? grid.linear(cell) : 0;
            marks[n] = inside && (own.fluid(c).size() > 0 || own.walls(c).size() > 0);
          });
}

/// Where the simulation is alone nothing is counted, and all nodes are given room.
template <int D>
class OwnCells {
 public:
  OwnCells(Context<Cuda>& context, const SortedParticles<D>& particles, const HatNodes<D, Cuda>& nodes)
      : count_(nodes.count()) {
    if (!context.halo) return;
    start_.resize(context, std::size_t{nodes.count()} + 1);
    markOwnCells(context, particles, nodes.view(), start_.data());
    count_ = startRows(context, start_);
  }

  std::uint32_t count() const { return count_; }
  OwnCellsView view() const { return {start_.data()}; }

 private:
  std::uint32_t count_;
  Buffer<std::uint32_t, Cuda> start_;
};

}  // namespace treacle
