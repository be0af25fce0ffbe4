#pragma once

#include "isph_matrix.hpp"
#include "treacle/linear/hat_multigrid.hpp"
#include "treacle/precondition/hat_grid.hpp"

#include <vector>

namespace treacle {

/// Sizes of a pressure equation that the memory traffic of its solvers follows from.
struct PressureSizes {
  struct Grid {
    std::uint64_t nodes, entries;
    bool dense;
  };
  int dimensions;
  std::uint64_t rows;
  PairCounts entries;       // of treacle's rows
  std::vector<Grid> grids;  // the hats' levels
};

/// Bytes that a method must move in an iteration: every kernel reads what it needs, and writes its results, once;
/// gathers that hit a cache are free, node numbers of the grids left out.
struct IterationBytes {
  const PressureSizes& sizes;
  double number;  // of the preconditioner and the coefficients [B]
  bool packed;    // IsphMatrix: 4 bytes per entry
  int gridDegree = 1;

  double ofSolver(PreconditionerKind kind) const {
    const double n = static_cast<double>(sizes.rows);
    switch (kind) {
      case PreconditionerKind::None:
        return ofCg() + 16 * n;  // z = r
      case PreconditionerKind::Jacobi:
        return ofCg() + 24 * n;  // r, diagonal, z
      case PreconditionerKind::HatMultigrid:
        return ofCg() + ofParticles() + ofGrids();
      default:
        return 0;  // not counted
    }
  }

 private:
  /// r.z 16; p 24; A p 40 and the entries; p.q 16; x and r 48 [B per row].
  double ofCg() const {
    const double entry = packed ? 4 : 4 + number;
    return 144.0 * static_cast<double>(sizes.rows) + entry * static_cast<double>(sizes.entries.all);
  }

  /// Two products with the near matrix; places in the cells; vectors: first sweep r, D^-1, x; residual row start,
  /// r, x, D^-1, res; restriction place, res; prolongation position, place, x twice; last sweep row start, r, x,
  /// D^-1, z.
  double ofParticles() const {
    const double d = sizes.dimensions, entry = packed ? 4 : 4 + number;
    const double row = 8 + 16 + 8 * d + 24 + number * (2 + 3 + (d + 1) + (d + 2) + 2);
    return row * static_cast<double>(sizes.rows) + 2 * entry * static_cast<double>(sizes.entries.near);
  }

  /// Per level 2 degree products (4 degree on a last level that is not dense, less the first step, which needs
  /// none), first step, residual, transfers.
  double ofGrids() const {
    double sum = 0;
    for (const PressureSizes::Grid& g : sizes.grids) {
      const double n = static_cast<double>(g.nodes),
                   product = static_cast<double>(g.entries) * (4 + number) + 8 * n;
      const bool last = &g == &sizes.grids.back();
      const int steps = last ? 4 * gridDegree - 1 : 2 * gridDegree - 1;
      if (g.dense)
        sum += number * (n * n + 2 * n);
      else
        sum += 4 * number * n + steps * (product + 7 * number * n) + (last ? 0 : product + 7 * number * n);
    }
    return sum;
  }
};

/// The levels that IsphHatMultigrid makes on the fluid of `pairs`.
template <int D>
std::vector<PressureSizes::Grid> gridSizes(Context<Cuda>& context, const IsphPairs<D>& pairs) {
  SortedParticles<D> fluid = pairs;
  fluid.activeCount = pairs.fluidCount;
  fluid.cells.wallEnd = fluid.cells.wallBegin;
  const std::uint32_t denseNodes = HatMultigrid<D, float, Cuda>().denseUnknowns();
  HatNodes<D, Cuda> nodes, coarser;
  BlockCsr<1, double, Cuda> pattern;
  std::vector<PressureSizes::Grid> grids;
  findHatNodes(context, fluid, HatsOn::Fluid, nodes);
  while (true) {
    hatPattern(context, nodes, pattern, 1);
    grids.push_back({nodes.count(), pattern.value.size(), nodes.count() <= denseNodes});
    if (grids.back().dense) return grids;
    coarserNodes<D>(context, nodes, coarser);
    if (coarser.count() > denseNodes && coarser.count() > 0.9 * nodes.count()) return grids;
    std::swap(nodes, coarser);
  }
}

}  // namespace treacle
