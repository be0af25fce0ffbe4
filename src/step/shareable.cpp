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
  if (c.solver.preconditioner == PreconditionerKind::CellMultigrid)
    refuse("solver.preconditioner = cell-multigrid",
           fmt::format("{}, {} or {}", nameOf(PreconditionerKind::HatMultigrid),
                       nameOf(PreconditionerKind::Jacobi), nameOf(PreconditionerKind::None)));
  if (c.method.kind == MethodKind::Isph) return;  // its matrix and its rows are the same whatever else is set
  if (backend == BackendKind::Cuda && c.solver.neighbours != NeighbourKind::Lists)
    refuse(fmt::format("solver.neighbours = {}", nameOf(c.solver.neighbours)),
           std::string(nameOf(NeighbourKind::Lists)));
  if (c.solver.operatorKind == OperatorKind::Assembled)
    refuse("solver.operator = assembled", std::string(nameOf(OperatorKind::MatrixFree)));
  if (c.solver.preconditioner == PreconditionerKind::BucketMultigrid)
    refuse("solver.preconditioner = bucket-multigrid",
           fmt::format("{}, {} or {}", nameOf(PreconditionerKind::ProjectedMultigrid),
                       nameOf(PreconditionerKind::BlockJacobi), nameOf(PreconditionerKind::Jacobi)));
}

}  // namespace treacle
