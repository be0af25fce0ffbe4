#pragma once

#include "memory_sum.hpp"
#include "mph_solver.hpp"
#include "surface_heat.hpp"
#include "treacle/mph/conduction.hpp"
#include "treacle/mph/surface_tension.hpp"
#include "treacle/mph/tension.hpp"
#include "treacle/mph/wall_surfaces.hpp"
#include "treacle/precondition/bucket_cells.hpp"

namespace treacle {

inline void planLists(const MemoryCounts::Lists& lists, MemorySum& sum) {
  sum.keep<std::uint64_t>(listSegments * lists.clusters + 1);
  sum.keep<std::uint8_t>(lists.clusters);
  for (std::uint64_t entries : lists.entries) sum.keep<std::uint32_t>(entries);
}

inline std::uint64_t entriesIn(const MemoryCounts::Lists& lists, std::initializer_list<ListSegment> segments) {
  std::uint64_t entries = 0;
  for (ListSegment s : segments) entries += lists.entries[static_cast<std::size_t>(s)];
  return entries;
}

/// StepHeat.
template <int D>
void planHeat(const Case& c, const MemoryCounts& n, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid;
  sum.keep<double>((c.heat->viscousHeating ? 10 : 9) * fluid + n.heldFluid());
  sum.keep<HeatExchange>(fluid);
  for (int k = 0; k < 4; ++k) sum.use<double>(StepPart::Solve, fluid);  // conjugate gradients
  if (!hasSurfaceHeat(c)) return;
  sum.keep<double>(fluid);
  sum.keep<Vec<D>>(fluid);
  sum.keep<HeatExchange>(fluid);
}

/// WallForces but for their lists, and what StepSurface keeps for them.
template <int D>
void planWallForces(const Case& c, const MemoryCounts& n, MemorySum& sum) {
  const std::uint64_t walls = n.activeWalls();
  sum.keep<double>(2 * walls);
  sum.keep<Vec<D>>(walls);
  if (c.keepsVolume()) sum.keep<Vec<D>>(n.active);
  if (c.hasSurfaceTension()) sum.keep<Vec<D>>(n.active + n.heldFluid());
}

/// What MphStep has besides lists and solver.
template <int D>
void planFields(const Case& c, const MemoryCounts& n, bool withGradient, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid, held = n.heldFluid(), walls = n.activeWalls();
  if (n.particles.surfaces > 0) sum.keep<WallSurface<D>>(walls);
  if (c.isAccurate()) sum.keep<SymmetricBlock<D>>(held);
  if (c.hasOwnViscosities()) {
    sum.keep<double>(3 * held + 2 * fluid);
    sum.keep<std::uint8_t>(n.active);
    sum.keep<Vec<D>>(n.active);
  } else if (c.method.viscosityCorrection != 0) {
    sum.keep<double>(held);
  }
  if (c.hasSurfaceTension()) {
    sum.keep<SurfaceSums<D>>(fluid);
    sum.keep<SurfaceSlope<D>>(held);
    sum.keep<Vec<D>>(3 * held + 2 * fluid);
    sum.keep<SurfaceFit>(held + fluid);
    sum.keep<WallSums<D>>(walls);
    sum.keep<Adhesion<D>>(n.active);
  }
  if (n.wallForceLists.clusters > 0) planLists(n.wallForceLists, sum);
  sum.keep<Block<D>>(fluid);
  if (withGradient) sum.keep<Vec<D>>(fluid);
  sum.keep<double>(fluid + (c.keepsVolume() ? 4 : 2) * n.active);
  sum.keep<Vec<D>>(fluid);
  if (c.keepsVolume()) {
    sum.keep<Vec<D>>(n.active + fluid);
    sum.keep<Covered>(held);
    sum.keep<double>(held + n.active);
  }
  if (c.heat) planHeat<D>(c, n, sum);
  if (c.hasRigid()) {  // pressures, the right-hand side at rest and velocities found
    sum.keep<double>(n.active);
    sum.keep<Vec<D>>(c.hasOwnViscosities() ? fluid : 2 * fluid);
  }
  if (c.needsBalance()) sum.keep<double>(fluid * (c.repulsionRadius() > 0 ? 2 : 1));
  if (c.needsWallForces()) planWallForces<D>(c, n, sum);
}

/// MphOperator, matrix-free.
template <int D>
void planOperator(const MemoryCounts& n, BackendKind backend, bool lists, bool renormalised, MemorySum& sum) {
  using enum ListSegment;
  const std::uint64_t fluid = n.particles.fluid;
  sum.keep<double>(n.active);
  if (backend == BackendKind::Cpu) {
    sum.keep<std::uint64_t>(2 * (n.fluidLists.clusters + 1));
    sum.keep<double>(clusterSize * (entriesIn(n.fluidLists, {NearFluid, FarFluid}) +
                                    entriesIn(n.fluidLists, {NearFluid, NearWall})));
    return;
  }
  sum.keep<Block<D>>(fluid);
  if (!renormalised) sum.keep<Vec<D>>(fluid);
  if (!lists) return;
  sum.keep<std::uint64_t>(n.active / nearSlice + 2);
  sum.keep<std::uint32_t>(n.nearEntries);
  sum.keep<std::int32_t>(4 * n.active);
}

/// StagedLists, with elements of so many bytes.
template <int D>
void planStaged(const MemoryCounts& n, std::uint64_t elementBytes, MemorySum& sum) {
  using Lists = StagedLists<D>;
  const unsigned sharing = Lists::sharing(n.particles.fluid);
  const std::uint64_t blocks = n.active * sharing / Lists::threads + 1;
  sum.keep<std::uint32_t>((Lists::capacity(sharing) + 1) * blocks);
  sum.keep<std::uint64_t>(n.active / nearSlice + 2 + n.stagedEntries / 4);
  sum.keep<std::uint8_t>(2 * elementBytes * n.stagedEntries);
  sum.keep<Gathered<D, float>>(n.particles.fluid);
}

/// Elements of C in few bits, of as many entries in lists of so many clusters.
inline void planPacked(std::uint64_t clusters, std::uint64_t entries, MemorySum& sum) {
  const std::uint64_t pairs = (entries + clusters) / 2;
  sum.keep<std::uint64_t>(clusters + 1);
  sum.keep<std::uint32_t>(clusters + (2 + 2 * clusterSize) * pairs);
}

/// ParticleProducts of the projected multigrid.
template <int D, class T>
void planProducts(const Case& c, const MemoryCounts& n, BackendKind backend, bool renormalised, MemorySum& sum) {
  using enum ListSegment;
  const std::uint64_t fluid = n.heldFluid();
  const bool stiff = isTooStiffToPack(makeMphPairs<D>(c));
  sum.keep<Block<D, T>>(fluid);
  if (backend == BackendKind::Cuda) {
    if (std::is_same_v<T, float> && !renormalised) {
      sum.keep<PlacedScalar>(2 * n.active);
      sum.keep<PlacedVector<D>>(n.active);
      return;
    }
    sum.keep<T>(2 * n.active);
    sum.keep<Gathered<D, T>>(n.active);
    if (std::is_same_v<T, float>) planStaged<D>(n, stiff ? 8 : 4, sum);
    return;
  }
  const std::uint64_t clusters = n.fluidLists.clusters;
  sum.keep<T>(2 * n.active);
  sum.keep<Gathered<D, T>>(fluid);
  sum.keep<Vec<D, T>>(n.active + clusterSize * (3 * clusters + n.wallLists.clusters));
  sum.keep<std::uint64_t>(2 * clusters + n.wallLists.clusters + 3);
  sum.keep<T>(clusterSize *
              (entriesIn(n.fluidLists, {NearFluid, FarFluid}) + entriesIn(n.fluidLists, {NearFluid, NearWall}) +
               entriesIn(n.wallLists, {NearFluid})));
  if (renormalised) sum.keep<SymmetricBlock<D, T>>(fluid);
  if (!std::is_same_v<T, float> || stiff) return;
  planPacked(clusters, entriesIn(n.fluidLists, {NearFluid, NearWall}), sum);
  planPacked(clusters, entriesIn(n.fluidLists, {NearFluid}), sum);
  planPacked(n.wallLists.clusters, entriesIn(n.wallLists, {NearFluid}), sum);
}

/// ProjectedMultigrid.
template <int D, class T>
void planProjected(const Case& c, const MemoryCounts& n, BackendKind backend, bool renormalised, MemorySum& sum) {
  const std::uint64_t fluid = n.heldFluid(), nodes = n.pressureGrids.front().nodes;
  planProducts<D, T>(c, n, backend, renormalised, sum);
  if (c.hasSeveralFluids()) {
    sum.keep<double>(fluid);
    sum.keep<std::uint8_t>(n.active);
  }
  sum.keep<T>(3 * n.active);
  sum.keep<Block<D, T>>(fluid);
  sum.keep<Gathered<D, T>>(4 * fluid);
  sum.keep<Vec<D, T>>(n.active);  // places in their cells, and on a CPU the corners of these
  constexpr std::uint64_t corners = 1 << D, slots = D == 2 ? 9 : 27;
  if (backend == BackendKind::Cpu) {
    sum.keep<std::uint32_t>(corners * n.active);
    sum.use<Vec<D, T>>(StepPart::Pressures, slots * fluid);
  } else {
    sum.use<T>(StepPart::Pressures, (corners * slots * slots + corners * corners) * nodes);
    sum.use<T>(StepPart::Velocities, D * D * corners * corners * n.fluidGrids.front().nodes);
  }
  sum.use<ViscousMoments<D, T>>(StepPart::Velocities, fluid);
  for (int k = 0; k < 3; ++k) sum.use<T>(StepPart::Estimate, n.active);
  planGrids<D, T, 1>(n.pressureGrids, backend, sum);
  planGrids<D, T, D>(n.fluidGrids, backend, sum);
}

/// BucketMultigrid of B unknowns per bucket, on a matrix of n.bucketEntries blocks that is there in double
/// precision; coarser levels have as many blocks per bucket.
template <int B, class T>
void planBuckets(const MemoryCounts& n, std::size_t levels, BackendKind backend, MemorySum& sum) {
  const double perRow =
      static_cast<double>(n.bucketEntries) / static_cast<double>(std::max<std::uint64_t>(n.buckets[0], 1));
  std::uint64_t children = n.particles.fluid;
  bool dense = false;
  for (std::size_t l = 0; l < std::min(levels, n.buckets.size()); ++l) {
    const std::uint64_t rows = n.buckets[l];
    const auto entries = static_cast<std::uint64_t>(perRow * static_cast<double>(rows));
    if (l == 0 || backend == BackendKind::Cuda) sum.keepRows<Block<B>>(rows, entries);
    sum.keepRows<Block<B, T>>(rows, entries);
    const bool becomesDense = backend == BackendKind::Cuda && B * rows <= 1100;
    // A matrix that stands for the rest of the cycle is made of it, 256 vectors at a time.
    const std::uint64_t columns = becomesDense ? std::min<std::uint64_t>(256, B * rows) : 1;
    sum.keep<Vec<B, T>>((1 + 3 * columns) * rows);
    if (becomesDense && !dense) sum.keep<T>(B * rows * B * rows);
    dense = dense || becomesDense;
    sum.keep<std::uint32_t>(children);
    children = rows;
  }
}

/// Those of all processes, of which a process has made a part.
template <int B>
void planBucketLevels(const MemoryCounts& n, MemorySum& sum) {
  for (std::uint64_t count : n.buckets) sum.keep<std::uint32_t>(count + 1);
  if (!n.isShared()) return sum.keep<std::uint32_t>(n.particles.fluid);
  sum.keep<std::uint32_t>(n.buckets[0] + n.heldFluid() + 2 * n.sharing.buckets);
  sum.keepRows<Block<B>>(n.sharing.buckets, n.sharing.bucketEntries);
}

/// Per unknown of A by cuSPARSE's products of sparse matrices, whose memory only it knows: as measured [B].
template <int D>
inline constexpr std::uint64_t spgemmBytes = D == 2 ? 4300 : 27800;

template <int D, class T>
void planPreconditioner(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid;
  const bool renormalised = c.isAccurate();
  const PreconditionerKind kind = c.solver.preconditioner;
  if (kind == PreconditionerKind::None) return;
  if (kind == PreconditionerKind::ProjectedMultigrid) return planProjected<D, T>(c, n, backend, renormalised, sum);
  sum.keep<Block<D>>(fluid);
  if (backend == BackendKind::Cuda) sum.borrow<double>(StepPart::Matrix, fluid * (D * (D + 1) / 2 + D));
  if (kind == PreconditionerKind::BlockJacobi) return sum.keep<Block<D, T>>(fluid);
  sum.keep<Vec<D, T>>(fluid);
  if (kind != PreconditionerKind::BucketMultigrid) return;
  planBucketLevels<D>(n, sum);
  planBuckets<D, T>(n, n.buckets.size(), backend, sum);
  if (backend == BackendKind::Cuda && c.solver.multigrid.coarseOperators == CoarseKind::Spgemm)
    return sum.keep<std::byte>(spgemmBytes<D> * D * fluid);
  sum.use<Vec<D>>(StepPart::Pressures, power<D>(2) * n.active);
  if (backend == BackendKind::Cuda) {
    sum.borrow<std::uint8_t>(StepPart::Pressures, n.active);
    sum.borrow<Block<D>>(StepPart::Pressures, n.bucketEntries);
  }
}

/// A step of MPH-I, its preconditioner in T.
template <int D, class T>
void planMph(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid;
  const bool renormalised = c.isAccurate(), onCpu = backend == BackendKind::Cpu;
  const bool lists = onCpu || c.solver.neighbours == NeighbourKind::Lists;
  if (lists) planLists(n.fluidLists, sum), planLists(n.wallLists, sum);
  planFields<D>(c, n, onCpu || !renormalised, sum);
  const PreconditionerKind kind = c.solver.preconditioner;
  if (c.solver.operatorKind == OperatorKind::MatrixFree || kind == PreconditionerKind::ProjectedMultigrid)
    planOperator<D>(n, backend, lists, renormalised, sum);
  if (storesMatrix(c, backend)) {
    sum.use<std::uint64_t>(StepPart::Matrix, n.active + 1);
    sum.use<std::uint32_t>(StepPart::Matrix, n.gradientEntries);
    sum.use<Vec<D>>(StepPart::Matrix, n.gradientEntries);
    sum.keepRows<Block<D>>(fluid, n.rowEntries);
    if (!onCpu) sum.borrow<Vec<D>>(StepPart::Matrix, fluid);
  }
  planPreconditioner<D, T>(c, n, backend, sum);
  planSolve(c, D * fluid, sum);
  // Recorded vectors, or A W.
  if (const std::uint64_t modes = modesOf(c); modes > 0)
    sum.keep<std::byte>(D * fluid * std::max(DeflationScalars::maxBasis * sizeof(float), modes * sizeof(double)));
}

}  // namespace treacle
