#include "treacle/step/run/shareable.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/search/cell_sort.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

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

void requireCells(const Case& c, std::uint64_t filled, int processes) {
  if (c.hasInflow() || static_cast<std::uint64_t>(processes) <= filled) return;
  throw InputError(fmt::format(
      "{} processes, but the fluid fills only {} cells of the search, the parts that it can be divided "
      "into; start fewer processes",
      processes, filled));
}

template <int D>
void requireCells(const Case& c, const CellGrid<D>& grid, const Particles<D>& some,
                  const Communicator& processes) {
  if (c.hasInflow()) return;
  std::vector<std::uint8_t> filled(grid.cellCount());
  for (const Vec<D>& x : some.position.span().first(some.fluidCount))
    if (isFinitePosition(x)) filled[grid.linear(grid.cellOf(x))] = 1;  // of others the sort says so
  processes.anyOf(filled);
  requireCells(c, static_cast<std::uint64_t>(std::ranges::count(filled, 1)), processes.size());
}

template void requireCells<2>(const Case&, const CellGrid<2>&, const Particles<2>&, const Communicator&);
template void requireCells<3>(const Case&, const CellGrid<3>&, const Particles<3>&, const Communicator&);

}  // namespace treacle
