#pragma once

#include "treacle/core/parallel.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/precondition/hat_cells.hpp"
#include "treacle/search/sorted_particles.hpp"

#include <algorithm>

namespace treacle {

/// The hat of a node at a particle of a cell that has it as a corner.
template <int D>
struct NodeHat {
  std::uint32_t node;
  double value;
  Vec<D> gradient;  // [1/m]
};

/// Blocks below the diagonal from those above.
template <int B>
void mirrorUpper(BlockCsr<B>& a) {
  parallelFor(a.rows(), parallelGrain, [&](std::size_t row) {
    for (std::uint64_t e = a.rowStart[row]; e < a.rowStart[row + 1]; ++e) {
      const std::size_t other = a.column[e];
      if (other >= row) continue;
      const std::uint32_t *begin = &a.column[a.rowStart[other]],
                          *end = begin + (a.rowStart[other + 1] - a.rowStart[other]);
      const Block<B>& above = a.value[a.rowStart[other] + (std::find(begin, end, row) - begin)];
      for (int r = 0; r < B; ++r)
        for (int c = 0; c < B; ++c) a.value[e](r, c) = above(c, r);
    }
  });
}

/// Galerkin operator that couples the corners of a cell by what each fluid particle in it adds: term(i, one hat,
/// the other) is a block.
template <int D, int B, class Term>
void cornerGalerkin(Context<Cpu>& context, const SortedParticles<D>& particles, const HatNodes<D>& nodes,
                    const Term& term, BlockCsr<B>& a) {
  const HatCells<D> cells{particles.grid};
  hatPattern(context, nodes, a, 1);
  parallelFor(nodes.count(), parallelGrain / 16, [&](std::size_t row) {
    const Vec<D, int> node = nodes.lattice.at(nodes.point[row]);
    for (std::uint64_t e = a.rowStart[row]; e < a.rowStart[row + 1]; ++e) {
      if (a.column[e] < row) continue;
      const Vec<D, int> other = nodes.lattice.at(nodes.point[a.column[e]]);
      Block<B> sum{};
      cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
        if (!cells.isCorner(other, cell)) return;
        particles.forEachOwnFluid(particles.grid.linear(cell), [&](std::uint32_t i) {
          const Vec<D> place = cells.fraction(particles.position[i], cell);
          NodeHat<D> p{static_cast<std::uint32_t>(row), 0, {}}, q{a.column[e], 0, {}};
          cells.cornerHat(node, cell, place, p.value, p.gradient);
          cells.cornerHat(other, cell, place, q.value, q.gradient);
          sum += term(i, p, q);
        });
      });
      a.value[e] = sum;
    }
  });
  mirrorUpper(a);
  sumRows<D>(context, nodes, 1, a);
}

}  // namespace treacle
