#include "treacle/step/memory_plan.hpp"

#include "isph_plan.hpp"
#include "mph_plan.hpp"
#include "mph_solver.hpp"
#include "treacle/step/solve_stages.hpp"

namespace treacle {

bool storesMatrix(const Case& c, BackendKind backend) {
  if (c.method.kind == MethodKind::Isph) return false;
  const bool products = backend == BackendKind::Cuda &&
                        c.solver.preconditioner == PreconditionerKind::BucketMultigrid &&
                        c.solver.multigrid.coarseOperators == CoarseKind::Spgemm;
  return products || needsAssembled<Cpu>(c.solver);
}

MemoryPlan planMemory(const Case& c, const MemoryCounts& n, BackendKind backend) {
  const bool mixed = solveStages(c).front().precision == Precision::Mixed;
  const auto plan = [&]<int D>(std::integral_constant<int, D>) {
    MemorySum sum;
    planState<D>(c, n, backend, sum);
    if (c.method.kind == MethodKind::Isph)
      mixed ? planIsph<D, float>(c, n, backend, sum) : planIsph<D, double>(c, n, backend, sum);
    else
      mixed ? planMph<D, float>(c, n, backend, sum) : planMph<D, double>(c, n, backend, sum);
    return sum.plan();
  };
  return c.dimensions == 2 ? plan(std::integral_constant<int, 2>{}) : plan(std::integral_constant<int, 3>{});
}

std::uint64_t distantWallBytes(const Case& c, const MemoryCounts& n) {
  return c.dimensions == 2 ? distantBytes<2>(n) : distantBytes<3>(n);
}

std::uint64_t stateBytes(const Case& c, ParticleNumbers n) {
  n.modes = std::max(n.modes, modesOf(c));
  return c.dimensions == 2 ? fieldBytes<2>(n) : fieldBytes<3>(n);
}

}  // namespace treacle
