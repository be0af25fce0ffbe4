#pragma once

#include "memory_sum.hpp"
#include "mph_plan.hpp"
#include "treacle/isph/isph_matrix.hpp"
#include "treacle/isph/isph_pairs.hpp"
#include "treacle/isph/isph_sums.hpp"

namespace treacle {

/// IsphSystem, its matrix and preconditioner in T, and the vectors of its solves.
template <int D, class T>
void planIsphSystem(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid, held = n.heldFluid(), entries = n.fluidOfFluid;
  const bool packed =
      backend == BackendKind::Cuda && std::is_same_v<T, float> && fluid >= PackedEntries<Cuda>::fewest;
  if (packed) {
    using Blocks = ColumnBlocksView;
    sum.keep<std::uint32_t>(entries + 3 * fluid);  // sections of rows are filled up to fours
    sum.keep<std::uint32_t>(2 * fluid + 1);
    const std::uint64_t blocks = (fluid + Blocks::rows - 1) / Blocks::rows;
    sum.keep<Blocks::Run>(Blocks::runs * blocks);
    sum.keep<Blocks::Size>(blocks);
  } else {
    sum.keep<T>(entries);
  }
  sum.keep<T>(fluid);
  sum.keep<double>(fluid);
  sum.use<IsphMoments<D>>(StepPart::Pressures, fluid);
  planSolve(c, fluid, sum);
  if (c.solver.preconditioner == PreconditionerKind::HatMultigrid) {
    constexpr std::uint64_t corners = 1 << D;
    sum.keep<T>(fluid + held);
    sum.keep<Vec<D, T>>(held);  // places in their cells, and on a CPU the corners of these
    if (backend == BackendKind::Cpu) sum.keep<std::uint32_t>(corners * held);
    if (backend == BackendKind::Cuda) {
      sum.use<T>(StepPart::Pressures, corners * corners * n.fluidGrids.front().nodes);
      sum.keep<T>(HatTransfer<D, T, Cuda>::sumsPerNode * n.fluidGrids.front().nodes);
    }
    planGrids<D, T, 1>(n.fluidGrids, backend, sum);
  } else if (c.solver.preconditioner == PreconditionerKind::CellMultigrid) {
    planBucketLevels<1>(n, sum);
    sum.keepRows<double>(fluid, entries);
    sum.keep<T>(fluid);
    const int levels = c.solver.cells.levels;
    planBuckets<1, T>(n, levels == 0 ? n.buckets.size() : static_cast<std::size_t>(levels), backend, sum);
    if (backend == BackendKind::Cuda) sum.keep<std::byte>(spgemmBytes<D> / 4 * fluid);
  }
}

/// A step of ISPH.
template <int D, class T>
void planIsph(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid, held = n.heldFluid(), walls = n.activeWalls(),
                      ownWalls = walls - n.sharing.ghostWalls;
  for (const auto& [rows, entries] :
       {std::pair{fluid, n.fluidOfFluid}, std::pair{fluid, n.wallsOfFluid}, std::pair{ownWalls, n.fluidOfWalls}}) {
    sum.keep<std::uint64_t>(2 * rows + 1);
    sum.keep<std::uint32_t>(entries);
  }
  if (backend == BackendKind::Cuda) sum.borrow<float>(StepPart::Matrix, 4 * n.active);  // while rows are found
  sum.keep<Vec<D>>(fluid + n.active);                                                   // deficit, v*
  sum.keep<std::uint8_t>(held);
  sum.keep<double>(2 * fluid + held);
  if (c.method.isph.shifting != 0) sum.keep<Vec<D>>(fluid);
  if (c.hasLoads() || c.hasRigid()) sum.keep<Vec<D>>(fluid + walls);
  if (c.hasRigid()) sum.keep<double>(fluid), sum.keep<WallSurface<D>>(walls);
  planIsphSystem<D, T>(c, n, backend, sum);
  const double limit = explicitViscousLimit(makeIsphPairs<D>(c));
  if (!isViscousStepImplicit(c.method.isph.viscosity, limit, c.time.step)) return;
  sum.keep<double>(D * fluid);
  MemorySum viscous;
  planIsphSystem<D, T>(c, n, backend, viscous);
  sum.addLater(viscous);
}

}  // namespace treacle
