#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/deflation_scalars.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/model/wall_motion.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/step/memory_plan.hpp"
#include "treacle/step/solve_stages.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace treacle {

/// Where in a step arrays are needed that nothing else of the step needs: they take each other's places.
enum class StepPart { Sort, Matrix, Pressures, Velocities, Estimate, Solve };

/// Adds up what arrays take: those that stay, and those that are given up (giveUp) once their part is done.
class MemorySum {
 public:
  /// `count` values of T.
  template <class T>
  void keep(std::uint64_t count) {
    held_ += count * sizeof(T);
  }
  template <class T>
  void use(StepPart part, std::uint64_t count) {
    const std::uint64_t bytes = count * sizeof(T);
    (bytes > keptBytes ? of_[static_cast<std::size_t>(part)] : held_) += bytes;
  }
  /// Of a buffer that is no member of anything.
  template <class T>
  void borrow(StepPart part, std::uint64_t count) {
    of_[static_cast<std::size_t>(part)] += count * sizeof(T);
  }
  template <class V>
  void keepRows(std::uint64_t rows, std::uint64_t entries) {
    keep<std::uint64_t>(rows + 1);
    keep<std::uint32_t>(entries);
    keep<V>(entries);
  }
  /// Arrays of another system, which is prepared and solved after this one.
  void addLater(const MemorySum& other) {
    held_ += other.held_;
    for (std::size_t k = 0; k < of_.size(); ++k) of_[k] = std::max(of_[k], other.of_[k]);
  }
  MemoryPlan plan() const { return {held_, held_ + *std::max_element(of_.begin(), of_.end())}; }

 private:
  std::uint64_t held_ = 0;
  std::array<std::uint64_t, 6> of_{};
};

/// Of all fields of Particles<D>.
template <int D>
std::uint64_t fieldBytes(const ParticleNumbers& n) {
  std::uint64_t sum = 0;
  const auto add = [&](std::uint64_t count) {
    return [&sum, count]<class T>(const Buffer<T>&) { sum += count * sizeof(T); };
  };
  const Particles<D> none;
  forEachSharedFieldOf(add(n.fluid + n.ghosts + n.wall), none);
  forEachFluidFieldOf(add(n.fluid), none);
  add(n.has.starts ? n.fluid + n.ghosts + n.wall : 0)(none.start);
  add(n.has.shearRates ? n.fluid : 0)(none.shearRate);
  add(n.has.temperatures ? n.fluid : 0)(none.temperature);
  add(n.has.viscosityFactors ? n.fluid : 0)(none.viscosityFactor);
  add(n.fluid * n.modes)(none.modes.vectors);
  forEachWallFieldOf(add(n.surfaces), none);
  return sum;
}

/// Modes that a solver may keep: in three dimensions it seldom finds any worth taking, and where there is no
/// memory for them it does without.
inline std::uint64_t modesOf(const Case& c) {
  const bool some = c.dimensions == 2 && c.method.kind == MethodKind::MphI && c.solver.deflates();
  return some ? static_cast<std::uint64_t>(c.solver.deflation) : 0;
}

/// DistantWalls, in the host's memory.
template <int D>
std::uint64_t distantBytes(const MemoryCounts& n) {
  constexpr std::uint64_t each = sizeof(Vec<D>) + 2 * sizeof(std::uint8_t) + sizeof(std::uint32_t);
  return (n.particles.wall - n.nearWalls) * (each + (n.particles.surfaces > 0 ? sizeof(WallSurface<D>) : 0));
}

/// Decomposition, and what is exchanged. Where processes share a GPU's step owners are on either side.
template <int D>
void planParts(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t sent = n.sharing.sentFluid + n.sharing.sentWalls;
  sum.keep<std::int32_t>(n.cells);
  sum.keep<std::uint8_t>(2 * n.cells);                                // places, cells with fluid
  if (backend == BackendKind::Cpu) sum.keep<std::uint32_t>(n.cells);  // their order
  sum.keep<std::uint32_t>(sent);
  // The largest value that goes to ghosts.
  const bool renormalised = c.isAccurate();
  sum.keep<std::byte>(sent * (renormalised ? sizeof(SymmetricBlock<D>) : sizeof(Vec<D>)));
  // A vector of the solve with its ghosts (withGhosts).
  sum.keep<std::byte>(n.heldFluid() * (c.method.kind == MethodKind::Isph ? sizeof(double) : sizeof(Vec<D>)));
  if (c.heat) sum.keep<double>(n.heldFluid());
}

/// The state, what a step makes of it, and its sort.
template <int D>
void planState(const Case& c, const MemoryCounts& n, BackendKind backend, MemorySum& sum) {
  const std::uint64_t fluid = n.particles.fluid, wall = n.nearWalls, all = n.heldFluid() + wall;
  ParticleNumbers numbers = n.particles;
  numbers.wall = wall;
  if (numbers.surfaces > 0) numbers.surfaces = wall;
  numbers.modes = std::max(numbers.modes, modesOf(c));
  numbers.has = {c.hasOwnViscosities(), c.heat.has_value(), c.hasViscosityFactors(), c.middleShare() > 0};
  sum.keep<std::byte>(fieldBytes<D>(numbers));
  sum.keep<Vec<D>>(n.wallsMove ? all : fluid);                             // positions of the end
  sum.keep<Vec<D>>(c.method.kind == MethodKind::MphI ? n.active : fluid);  // velocities
  if (someWallRotates(c) || someWallIsDriven(c) || c.hasInflow() || c.hasRigid()) sum.keep<Vec<D>>(wall);  // ways
  sum.keep<std::uint32_t>(4 * n.cells);  // ranges
  sum.keep<std::uint8_t>(n.cells);
  sum.keep<std::uint64_t>(fluid);
  if (n.isShared()) planParts<D>(c, n, backend, sum);
  if (backend == BackendKind::Cpu) {
    sum.keep<std::byte>(distantBytes<D>(n));
    sum.use<SortWorkspace<>::KeyedIndex>(StepPart::Sort, all);
    sum.use<Vec<D>>(StepPart::Sort, n.isShared() ? std::max(fluid, wall) : fluid);  // walls change hands
    return;
  }
  sum.use<std::uint64_t>(StepPart::Sort, all);
  sum.use<std::uint64_t>(StepPart::Sort, wall);
  sum.use<std::uint32_t>(StepPart::Sort, all);
  sum.use<std::uint32_t>(StepPart::Sort, all);
  sum.use<std::byte>(StepPart::Sort,
                     std::max(all * sizeof(Vec<D>), fluid * numbers.modes * sizeof(Vec<D, float>)));
  sum.use<std::byte>(StepPart::Sort, 12 * std::max(fluid, wall));  // keys and indices once more, in the radix sort
}

/// Vectors of the Krylov method, of `numbers` per fluid particle, and the guess for a fallback.
inline void planSolve(const Case& c, std::uint64_t unknowns, MemorySum& sum) {
  const int vectors = c.solver.krylov == KrylovKind::Cg ? 4 : 5;
  for (int k = 0; k < vectors; ++k) sum.use<double>(StepPart::Solve, unknowns);
  if (solveStages(c).size() > 1) sum.use<double>(StepPart::Solve, unknowns);
}

/// HatMultigrid with B unknowns per node on these grids, the finest matrix and nodes included.
template <int D, class T, int B>
void planGrids(const std::vector<MemoryCounts::Grid>& grids, BackendKind backend, MemorySum& sum) {
  const std::uint64_t most = backend == BackendKind::Cpu ? 200 : 1100;  // that are inverted
  for (const MemoryCounts::Grid& g : grids) {
    const std::uint64_t unknowns = B * g.nodes;
    sum.keep<std::uint32_t>(g.points + g.nodes);
    if (g.divided) {  // owners, which points are nodes; about as many nodes are others' ghosts as are ghosts here
      sum.keep<std::int32_t>(g.points + g.ghosts);
      sum.keep<std::uint8_t>(g.points);
      sum.keep<double>(D * g.ghosts);
    }
    sum.keepRows<Block<B>>(g.nodes, g.entries);
    sum.keep<T>(2 * unknowns);
    if (!g.divided && unknowns <= most) {
      sum.keep<T>(unknowns * unknowns);
      // A device inverts in panels of 32, with one row and one column of them beside the matrix.
      const std::uint64_t stride = (unknowns + 31) / 32 * 32;
      if (backend == BackendKind::Cuda) sum.borrow<double>(StepPart::Estimate, stride * (stride + 64));
      return;
    }
    if (sizeof(T) < sizeof(double)) sum.keep<Block<B, T>>(g.entries);
    sum.keep<T>(4 * unknowns);
  }
}

}  // namespace treacle
