#include "treacle/step/method/solve_stages.hpp"

#include "treacle/isph/isph_pairs.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/precondition/projected_multigrid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Light fluids under heavy ones have an additional viscosity once there is a pressure, which there is not in the
/// first step. They count with the geometric mean of both.
template <int D>
ProjectionConstants constantsOf(const Case& c) {
  MphPairs<D> pairs = makeMphPairs<D>(c);
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    const Material& material = c.materials[m];
    double& mu = pairs.classes.viscosity[m];
    mu = std::sqrt(mu * (mu + additionalViscosity(c, material, pressureOfHeavier(c, material))));
  }
  return projectionConstants(pairs);
}

/// The hat multigrid gives up early and is tried again in double precision; the last resort takes no
/// preconditioner that could fail.
std::vector<SolverSettings> isphStages(const Case& c) {
  if (c.solver.preconditioner != PreconditionerKind::HatMultigrid) return {c.solver};
  SolverSettings first = c.solver;
  if (first.hats.gridDegree == 0) first.hats.gridDegree = 1;
  first.maxIterations = std::min(first.hats.iterationBound, c.solver.maxIterations);
  SolverSettings exact = first;
  exact.precision = Precision::Double;
  exact.hats.gridDegree += 1;
  SolverSettings plain = c.solver;
  plain.krylov = KrylovKind::Cg;
  plain.preconditioner = PreconditionerKind::Jacobi;
  plain.precision = Precision::Double;
  return {first, exact, plain};
}

}  // namespace

std::vector<SolverSettings> solveStages(const Case& c) {
  if (c.method.kind == MethodKind::Isph) return isphStages(c);
  if (c.solver.preconditioner != PreconditionerKind::ProjectedMultigrid) return {c.solver};
  const ProjectionConstants constants = c.dimensions == 2 ? constantsOf<2>(c) : constantsOf<3>(c);
  const ProjectedSettings& chosen = c.solver.projected;
  const ProjectionDegrees degrees =
      chooseDegrees({chosen.pressureDegree, chosen.gridDegree, chosen.velocityDegree}, constants);
  const int bound = chosen.iterationBound;

  SolverSettings first = c.solver;
  first.projected = {degrees.pressure, degrees.grid, degrees.velocity, bound};
  first.maxIterations = std::min(bound, c.solver.maxIterations);
  if (constants.stiffness > mostSingleStiffness) first.precision = Precision::Double;

  SolverSettings stronger = first;
  stronger.deflation = 0;
  stronger.projected.pressureDegree *= 2;
  stronger.projected.velocityDegree += 1;
  stronger.precision = Precision::Double;

  SolverSettings papers = c.solver;
  papers.krylov = KrylovKind::Cr;
  papers.deflation = 0;
  papers.preconditioner = PreconditionerKind::BucketMultigrid;
  papers.precision = Precision::Double;
  papers.multigrid = {};
  return {first, stronger, papers};
}

std::string viscousText(const Case& c) {
  const double limit =
      c.dimensions == 2 ? explicitViscousLimit(makeIsphPairs<2>(c)) : explicitViscousLimit(makeIsphPairs<3>(c));
  if (std::isinf(limit)) return "none: no viscosity";
  const bool implicit = isViscousStepImplicit(c.method.isph.viscosity, limit, c.time.step);
  return fmt::format("{} ({} time steps of {:.3g} s)", implicit ? "implicit" : "explicit",
                     implicit ? "explicit would bear" : "up to", limit);
}

std::string solverText(const SolverSettings& settings) {
  std::string text = fmt::format("{}, {}, {}", nameOf(settings.krylov), nameOf(settings.preconditioner),
                                 nameOf(settings.precision));
  if (settings.preconditioner == PreconditionerKind::ProjectedMultigrid)
    text +=
        fmt::format(": pressure degree {}, grid degree {}, velocity degree {}", settings.projected.pressureDegree,
                    settings.projected.gridDegree, settings.projected.velocityDegree);
  if (settings.preconditioner == PreconditionerKind::ProjectedMultigrid && settings.krylov == KrylovKind::Cg &&
      settings.deflation > 0)
    text += fmt::format(", deflation by up to {} modes", settings.deflation);
  if (settings.preconditioner == PreconditionerKind::HatMultigrid)
    text += fmt::format(": grid degree {}", settings.hats.gridDegree);
  if (settings.preconditioner == PreconditionerKind::CellMultigrid)
    text += fmt::format(": {} levels, {} sweeps",
                        settings.cells.levels > 0 ? std::to_string(settings.cells.levels) : "all",
                        settings.cells.sweeps);
  return text;
}

}  // namespace treacle
