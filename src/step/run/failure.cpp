#include "failure.hpp"

#include "treacle/core/processes.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {
namespace {

template <int D>
std::string describe(const Vec<D>& x) {
  std::string text = fmt::format("({:.6g}", x[0]);
  for (int k = 1; k < D; ++k) text += fmt::format(", {:.6g}", x[k]);
  return text + ")";
}

template <int D>
bool isFinite(const Vec<D>& v) {
  return std::isfinite(norm2(v));
}

}  // namespace

std::string describeStage(const SolverSettings& stage, const SolveReport& report) {
  const std::string_view what = report.status == SolveStatus::IterationLimit ? "no convergence"
                                : report.status == SolveStatus::Breakdown    ? "breakdown"
                                                                             : "a value that is not finite";
  return fmt::format("{}: {} after {} iterations, |r|^2/|b|^2 = {:.3g}", solverText(stage), what,
                     report.iterations, report.residual);
}

std::string describeFailure(const SolveReport& report, double tolerance, const std::string& failures) {
  std::string numbers = fmt::format("|r|^2/|b|^2 = {:.3g} after {} iterations (tolerance {:.3g})", report.residual,
                                    report.iterations, tolerance);
  if (!failures.empty()) numbers += fmt::format("; tried before: {}", failures);
  switch (report.status) {
    case SolveStatus::IterationLimit:
      return "the linear solver did not converge: " + numbers +
             "; raise solver.max_iterations, or reduce the time step or, of MPH-I, the bulk viscosity";
    case SolveStatus::Breakdown:
      return "the linear solver broke down, operator or preconditioner is not positive definite in working "
             "precision: " +
             numbers;
    default:
      return "the linear solver met a value that is not finite: " + numbers;
  }
}

std::string describeHeatFailure(const SolveReport& report, const HeatSettings& settings) {
  if (report.status == SolveStatus::IterationLimit)
    return fmt::format(
        "the temperatures did not converge: |r|^2/|b|^2 = {:.3g} after {} iterations (tolerance {:.3g}); "
        "raise heat.max_iterations, or reduce the time step",
        report.residual, report.iterations, settings.tolerance);
  return fmt::format(
      "the solver for temperatures met a value that is not finite after {} iterations; look at "
      "viscosities and velocities of the last frame",
      report.iterations);
}

std::string describeFreezingFailure(double left, int systems, const HeatSettings& settings) {
  return fmt::format(
      "the temperatures of fluid that freezes did not converge: |r|^2/|b|^2 = {:.3g} after {} linear systems "
      "(tolerance {:.3g}); reduce the time step, or take freezing with a wider range from solidus to liquidus",
      left, systems, settings.tolerance);
}

std::string describeViscosities(double particles) {
  return fmt::format(
      "the viscosities of {:.0f} particles are negative or not finite; look at the viscosity_factor and "
      "yield_factor of their materials, and at the states and temperatures of the last frame",
      particles);
}

std::string describeElasticity(double particles) {
  return fmt::format(
      "the elastic stresses of {:.0f} particles are not finite; reduce the time step, or give the "
      "elastic modes a mobility or extensibility that bounds how far they stretch",
      particles);
}

std::string describeVolumes(double particles) {
  return fmt::format(
      "the volume_factor of {:.0f} particles is not between 0.75 and 1.33; look at those of the "
      "materials, and at the states and temperatures of the last frame",
      particles);
}

std::string describeStates(double particles) {
  return fmt::format(
      "the states of {:.0f} particles are not finite; look at the rates of their materials' states, "
      "and at the states, temperatures and shear rates of the last frame",
      particles);
}

template <int D>
std::string describeNotFinite(const Processes& processes, const Particles<D>& particles,
                              std::span<const Vec<D>> b) {
  std::string found;
  for (std::uint32_t i = 0; i < particles.fluidCount && found.empty(); ++i)
    if (!isFinite(b[i]) || !isFinite(particles.position[i]))
      found = fmt::format("the right-hand side of particle {} at {} m is not finite", particles.id[i],
                          describe(particles.position[i]));
  return firstText(processes, found, "the right-hand side is finite");
}

template <int D>
std::string describeLeaving(const Case& c, const Particles<D>& particles, std::uint32_t i, const Vec<D>& u,
                            double dt) {
  const Vec<D>& x = particles.position[i];
  std::string which = fmt::format("{} particle {}", i < particles.fluidCount ? "fluid" : "wall", particles.id[i]);
  if (particles.body[i] < c.bodies.size()) which += fmt::format(" of '{}'", c.bodies[particles.body[i]].name);
  if (isFinite(x) && !isFinite(u))
    return fmt::format("the velocity of {} at {} m is not finite: {} m/s", which, describe(x), describe(u));
  return fmt::format("{} left the domain: from {} m to {} m at velocity {} m/s", which, describe(x),
                     describe(x + dt * u), describe(u));
}

template std::string describeNotFinite<2>(const Processes&, const Particles<2>&, std::span<const Vec<2>>);
template std::string describeNotFinite<3>(const Processes&, const Particles<3>&, std::span<const Vec<3>>);
template std::string describeLeaving<2>(const Case&, const Particles<2>&, std::uint32_t, const Vec<2>&, double);
template std::string describeLeaving<3>(const Case&, const Particles<3>&, std::uint32_t, const Vec<3>&, double);

}  // namespace treacle
