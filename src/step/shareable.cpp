#include "treacle/step/shareable.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/names.hpp"

#include <fmt/format.h>

namespace treacle {

void requireShareable(const Case& c, BackendKind backend) {
  const auto refuse = [](const std::string& what, const std::string& expected) {
    throw InputError(
        fmt::format("several processes cannot share {}; expected {}, or one process", what, expected));
  };
  if (c.method.kind == MethodKind::Isph) return;  // its matrix and its rows are the same whatever else is set
  if (backend == BackendKind::Cuda && c.solver.neighbours != NeighbourKind::Lists)
    refuse(fmt::format("solver.neighbours = {}", nameOf(c.solver.neighbours)),
           std::string(nameOf(NeighbourKind::Lists)));
  if (c.solver.operatorKind == OperatorKind::Assembled)
    refuse("solver.operator = assembled", std::string(nameOf(OperatorKind::MatrixFree)));
  if (c.solver.preconditioner != PreconditionerKind::BucketMultigrid) return;
  const MultigridSettings& buckets = c.solver.multigrid;  // what needs the assembled matrix
  if (buckets.particleDiagonal == SmootherDiagonal::ExtendedJacobi)
    refuse(fmt::format("solver.multigrid.particle_diagonal = {}", nameOf(buckets.particleDiagonal)),
           std::string(nameOf(SmootherDiagonal::Jacobi)));
  if (backend == BackendKind::Cuda && buckets.coarseOperators == CoarseKind::Spgemm)
    refuse(fmt::format("solver.multigrid.coarse_operators = {}", nameOf(buckets.coarseOperators)),
           std::string(nameOf(CoarseKind::Direct)));
}

}  // namespace treacle
