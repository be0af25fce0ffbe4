#include "case_settings.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace treacle {
namespace {

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

}  // namespace

TimeSettings readTime(const Section& top, double resolution) {
  const Section s = top.required("time", {"step", "end"});
  TimeSettings time;
  time.step = s.number("step", Bound::Positive, "s") / resolution;
  time.end = s.number("end", Bound::Positive, "s");
  const double steps = time.end / time.step;
  if (steps < 0.5)
    throw s.error("end", fmt::format("expected at least one step of {} s, found {}", time.step, time.end));
  if (steps > 1e15) throw s.error("step", fmt::format("{:.3g} steps to the end are too many", steps));
  return time;
}

MethodSettings readMethod(const Section& top) {
  const Section s = top.section("method", "[method]", {"name", "pressure_radius", "viscosity_radius"});
  MethodSettings method;
  method.name = s.string("name", method.name);
  if (method.name != "mph-i") throw s.error("name", fmt::format("expected 'mph-i', found '{}'", method.name));
  method.pressureRadius = s.number("pressure_radius", Bound::Positive, "spacings", method.pressureRadius);
  method.viscosityRadius = s.number("viscosity_radius", Bound::Positive, "spacings", method.viscosityRadius);
  return method;
}

SolverSettings readSolver(const Section& top) {
  const Section s = top.section("solver", "[solver]",
                                {"krylov", "preconditioner", "tolerance", "max_iterations", "operator",
                                 "neighbours", "precision", "first_guess", "multigrid", "projected"});
  SolverSettings solver;
  solver.preconditioner = s.choice<PreconditionerKind>("preconditioner", solver.preconditioner);
  const bool projected = solver.preconditioner == PreconditionerKind::ProjectedMultigrid;
  solver.krylov = s.choice<KrylovKind>("krylov", projected ? KrylovKind::Cg : KrylovKind::Cr);
  solver.operatorKind = s.choice<OperatorKind>("operator", solver.operatorKind);
  solver.neighbours = s.choice<NeighbourKind>("neighbours", solver.neighbours);
  solver.precision = s.choice<Precision>("precision", projected ? Precision::Mixed : Precision::Double);
  solver.firstGuess = s.choice<FirstGuess>("first_guess", solver.firstGuess);
  solver.tolerance = s.number("tolerance", Bound::Positive, "", solver.tolerance);
  if (solver.tolerance >= 1)
    throw s.error("tolerance", fmt::format("expected a number between 0 and 1, found {}", solver.tolerance));
  solver.maxIterations = s.integer("max_iterations", 1, solver.maxIterations);
  solver.multigrid = readMultigrid(s);
  solver.projected = readProjected(s);
  if (solver.neighbours == NeighbourKind::Ranges) refuseWithoutLists(s, solver);
  return solver;
}

OutputSettings readOutput(const Section& top) {
  const Section s =
      top.section("output", "[output]", {"interval", "checkpoint_interval", "fields", "format", "precision"});
  OutputSettings output;
  output.interval = s.number("interval", Bound::NonNegative, "s", output.interval);
  output.checkpointInterval = s.number("checkpoint_interval", Bound::NonNegative, "s", output.checkpointInterval);
  output.precision = s.choice<OutputPrecision>("precision", output.precision);
  if (const std::string format = s.string("format", "vtp"); format != "vtp")
    throw s.error("format", fmt::format("expected 'vtp', found '{}'", format));
  if (const auto words = s.strings("fields")) {
    output.fields = {false, false, false, false, false};
    for (const std::string& word : *words) {
      const auto named = std::ranges::find(outputFieldNames, word, &OutputFieldName::name);
      if (named == std::end(outputFieldNames)) {
        std::vector<std::string_view> names;
        for (const OutputFieldName& f : outputFieldNames) names.push_back(f.name);
        throw s.error("fields", fmt::format("expected {}, found '{}'", listOf(names), word));
      }
      output.fields.*(named->flag) = true;
    }
  }
  return output;
}

}  // namespace treacle
