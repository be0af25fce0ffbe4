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
  if (backend != BackendKind::Cpu) refuse("a run on GPUs", "--backend cpu");
  if (c.method.kind != MethodKind::MphI)
    refuse(fmt::format("method.name = {}", nameOf(c.method.kind)), std::string(nameOf(MethodKind::MphI)));
  if (c.solver.operatorKind == OperatorKind::Assembled)
    refuse("solver.operator = assembled", std::string(nameOf(OperatorKind::MatrixFree)));
  if (c.solver.preconditioner == PreconditionerKind::BucketMultigrid)
    refuse("solver.preconditioner = bucket-multigrid",
           fmt::format("{}, {} or {}", nameOf(PreconditionerKind::ProjectedMultigrid),
                       nameOf(PreconditionerKind::BlockJacobi), nameOf(PreconditionerKind::Jacobi)));
}

}  // namespace treacle
