#include "case_settings.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

using Keys = std::vector<std::string_view>;

const Keys sharedKeys{"krylov", "preconditioner", "tolerance", "max_iterations", "precision", "first_guess"};
const Keys mphKeys{"operator", "neighbours", "deflation", "multigrid", "projected"};
const Keys isphKeys{"cells", "hats"};

MultigridSettings readMultigrid(const Section& solver) {
  const Section s = solver.section(
      "multigrid", "[solver.multigrid]",
      {"finest_sweeps", "middle_sweeps", "coarsest_sweeps", "particle_diagonal", "coarse_operators"});
  MultigridSettings multigrid;
  multigrid.finestSweeps = s.integer("finest_sweeps", 1, multigrid.finestSweeps);
  multigrid.middleSweeps = s.integer("middle_sweeps", 1, multigrid.middleSweeps);
  multigrid.coarsestSweeps = s.integer("coarsest_sweeps", 1, multigrid.coarsestSweeps);
  multigrid.particleDiagonal = s.choice<SmootherDiagonal>("particle_diagonal", multigrid.particleDiagonal);
  multigrid.coarseOperators = s.choice<CoarseKind>("coarse_operators", multigrid.coarseOperators);
  return multigrid;
}

ProjectedSettings readProjected(const Section& solver) {
  const Section s = solver.section("projected", "[solver.projected]",
                                   {"pressure_degree", "grid_degree", "velocity_degree", "iteration_bound"});
  ProjectedSettings projected;
  projected.pressureDegree = s.integer("pressure_degree", 0, projected.pressureDegree);
  projected.gridDegree = s.integer("grid_degree", 0, projected.gridDegree);
  projected.velocityDegree = s.integer("velocity_degree", 0, projected.velocityDegree);
  projected.iterationBound = s.integer("iteration_bound", 1, projected.iterationBound);
  return projected;
}

CellSettings readCells(const Section& solver) {
  const Section s = solver.section("cells", "[solver.cells]", {"levels", "sweeps"});
  CellSettings cells;
  cells.levels = s.integer("levels", 0, cells.levels);
  cells.sweeps = s.integer("sweeps", 1, cells.sweeps);
  return cells;
}

HatSettings readHats(const Section& solver) {
  const Section s = solver.section("hats", "[solver.hats]", {"grid_degree", "iteration_bound"});
  HatSettings hats;
  hats.gridDegree = s.integer("grid_degree", 0, hats.gridDegree);
  hats.iterationBound = s.integer("iteration_bound", 1, hats.iterationBound);
  return hats;
}

/// What needs neighbour lists.
void refuseWithoutLists(const Section& s, const SolverSettings& solver) {
  const auto refuse = [&](std::string_view key, std::string_view word) {
    throw s.error("neighbours",
                  fmt::format("expected 'lists' with {} = '{}', found 'ranges': that needs lists", key, word));
  };
  const MultigridSettings& m = solver.multigrid;
  if (solver.preconditioner == PreconditionerKind::ProjectedMultigrid)
    refuse("preconditioner", nameOf(solver.preconditioner));
  if (solver.operatorKind == OperatorKind::Assembled) refuse("operator", nameOf(solver.operatorKind));
  if (m.particleDiagonal == SmootherDiagonal::ExtendedJacobi)
    refuse("multigrid.particle_diagonal", nameOf(m.particleDiagonal));
  if (m.coarseOperators == CoarseKind::Spgemm) refuse("multigrid.coarse_operators", nameOf(m.coarseOperators));
}

bool fits(PreconditionerKind preconditioner, MethodKind method) {
  switch (preconditioner) {
    case PreconditionerKind::None:
    case PreconditionerKind::Jacobi:
      return true;
    case PreconditionerKind::CellMultigrid:
    case PreconditionerKind::HatMultigrid:
      return method == MethodKind::Isph;
    case PreconditionerKind::BlockJacobi:
    case PreconditionerKind::BucketMultigrid:
    case PreconditionerKind::ProjectedMultigrid:
      break;
  }
  return method == MethodKind::MphI;
}

/// What a case has unless its file says otherwise, as far as that does not follow from the preconditioner.
SolverSettings defaultsOf(MethodKind method) {
  SolverSettings solver;
  if (method == MethodKind::MphI) return solver;
  solver.preconditioner = PreconditionerKind::HatMultigrid;
  solver.firstGuess = FirstGuess::Last;
  return solver;
}

/// The keys that mean something for MPH-I alone.
void readMphSolver(const Section& s, SolverSettings& solver) {
  solver.operatorKind = s.choice<OperatorKind>("operator", solver.operatorKind);
  solver.neighbours = s.choice<NeighbourKind>("neighbours", solver.neighbours);
  solver.deflation = s.integer("deflation", 0, solver.deflation);
  if (solver.deflation > maxModes)
    throw s.error("deflation", fmt::format("expected at most {} modes, found {}", maxModes, solver.deflation));
  solver.multigrid = readMultigrid(s);
  solver.projected = readProjected(s);
  if (solver.neighbours == NeighbourKind::Ranges) refuseWithoutLists(s, solver);
}

}  // namespace

SolverSettings readSolver(const Section& top, MethodKind method) {
  const bool isph = method == MethodKind::Isph;
  Keys keys = sharedKeys;
  const Keys& own = isph ? isphKeys : mphKeys;
  keys.insert(keys.end(), own.begin(), own.end());
  const Section s = top.section("solver", isph ? "[solver] (isph)" : "[solver]", keys,
                                isph ? keysOf(MethodKind::MphI, mphKeys) : keysOf(MethodKind::Isph, isphKeys));
  SolverSettings solver = defaultsOf(method);
  solver.preconditioner = s.choiceIf<PreconditionerKind>("preconditioner", solver.preconditioner,
                                                         [&](PreconditionerKind p) { return fits(p, method); });
  // With the other preconditioners MPH-I is solved as its authors do.
  const bool plain = !isph && solver.preconditioner != PreconditionerKind::ProjectedMultigrid;
  solver.krylov = s.choice<KrylovKind>("krylov", plain ? KrylovKind::Cr : KrylovKind::Cg);
  solver.precision = s.choice<Precision>("precision", plain ? Precision::Double : Precision::Mixed);
  // Pressures at the free surface come and go: nothing follows from those of several steps.
  solver.firstGuess = s.choiceIf<FirstGuess>("first_guess", solver.firstGuess,
                                             [&](FirstGuess g) { return !isph || g == FirstGuess::Last; });
  solver.tolerance = s.number("tolerance", Bound::Positive, "", solver.tolerance);
  if (solver.tolerance >= 1)
    throw s.error("tolerance", fmt::format("expected a number between 0 and 1, found {}", solver.tolerance));
  solver.maxIterations = s.integer("max_iterations", 1, solver.maxIterations);
  if (isph)
    solver.cells = readCells(s), solver.hats = readHats(s);
  else
    readMphSolver(s, solver);
  return solver;
}

}  // namespace treacle
