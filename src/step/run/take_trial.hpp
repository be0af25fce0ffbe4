#pragma once

#include "flow_state.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/phase_clock.hpp"
#include "treacle/step/method/solve_stages.hpp"
#include "treacle/step/method/solver_trial.hpp"

#include <cmath>
#include <type_traits>

namespace treacle {

/// The settings with what the program chooses filled in, and without any stage to fall back to.
inline SolverSettings singleStage(Case c, const SolverSettings& settings) {
  c.solver = settings;
  SolverSettings stage = solveStages(c).front();
  stage.maxIterations = settings.maxIterations;
  return stage;
}

/// `prepare()` makes a solver of one stage ready, `solve(history)` solves by it from the first guess; both are
/// called several times.
template <class Backend, class Prepare, class Solve>
SolverTrial takeTrial(Context<Backend>& context, const SolverSettings& settings, Prepare&& prepare,
                      Solve&& solve) {
  Buffer<double, Backend> history;
  history.resize(context, static_cast<std::size_t>(settings.maxIterations) + 1);
  // Memory that is allocated and kernels that are loaded at the first call are not part of a step's time.
  prepare();
  if constexpr (std::is_same_v<Backend, Cuda>) solve(history.data());

  PhaseClock<Backend> clock;
  clock.start(context);
  prepare();
  clock.mark(context);
  SolverTrial trial;
  trial.report = solve(history.data());
  clock.mark(context);
  trial.solver = solverText(settings);
  trial.setupSeconds = clock.seconds()[0], trial.solveSeconds = clock.seconds()[1];

  Buffer<double> squares(static_cast<std::size_t>(trial.report.iterations) + 1);
  copyToHost(context, std::span<const double>(history).first(squares.size()), squares.data());
  for (const double square : squares) trial.residuals.push_back(std::sqrt(square));
  return trial;
}

}  // namespace treacle
