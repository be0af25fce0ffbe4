#include "treacle/io/tables/convergence.hpp"
#include "backend.hpp"
#include "case_input.hpp"
#include "commands.hpp"
#include "compared_solvers.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "patience.hpp"
#include "print.hpp"
#include "progress.hpp"
#include "resume.hpp"
#include "run_log.hpp"
#include "threads.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace treacle {
namespace {

namespace fs = std::filesystem;

/// The state that the way to the system begins at; `until` then ends where the system is to be.
StartState startOf(Case& until, const ConvergenceOptions& options, MadeParticles made) {
  StartState start =
      options.resume.empty() ? StartState{std::move(made.particles)} : fittingState(until, options.resume, made);
  const double end = std::exchange(until.time.end, options.at.value_or(start.time));
  if (const double steps = until.time.end / until.time.step; steps > maxSteps)
    throw InputError(fmt::format("--at: {:.3g} steps to it are too many", steps));
  if (until.time.end > 100 * end)
    throw InputError(fmt::format(
        "--at: {:g} s is more than a hundred times the end of the case, {:g} s (time.end)", until.time.end, end));
  if (until.time.stepsVary() ? until.time.end < start.time * (1 - 1e-9) : until.steps() < start.step)
    throw InputError(fmt::format("--at: expected at least the checkpoint's time, {:g} s, found {:g}", start.time,
                                 until.time.end));
  return start;
}

void advanceToEnd(const Case& c, AnySimulation& simulation) {
  if (c.atEnd(simulation.step(), simulation.time())) return;
  Progress progress(c, simulation.step(), simulation.time(), false);
  while (!c.atEnd(simulation.step(), simulation.time())) try {
      progress.update(simulation.advance());
    } catch (const RunError& error) {
      progress.endLine();
      throw RunError(
          fmt::format("after step {} (t = {:.6g} s): {}", simulation.step(), simulation.time(), error.what()));
    }
}

const char* outcomeText(SolveStatus status) {
  switch (status) {
    case SolveStatus::Converged:
      return "converged";
    case SolveStatus::IterationLimit:
      return "iteration limit";
    case SolveStatus::Breakdown:
      return "breakdown";
    default:
      return "not finite";
  }
}

/// Solvers may differ in what solverText() does not tell.
void numberEqualNames(std::vector<ConvergenceCurve>& curves) {
  for (std::size_t k = 0; k < curves.size(); ++k) {
    int number = 1;
    const std::string name = curves[k].solver;
    for (std::size_t later = k + 1; later < curves.size(); ++later)
      if (curves[later].solver == name) curves[later].solver += fmt::format(" ({})", ++number);
    if (number > 1) curves[k].solver += " (1)";
  }
}

void printTable(const std::vector<ConvergenceCurve>& curves) {
  std::size_t widest = 6;
  for (const ConvergenceCurve& curve : curves) widest = std::max(widest, curve.solver.size());
  print("{:{}}  iterations  |r| / |b|  set-up [ms]  solve [ms]\n", "solver", widest);
  for (const ConvergenceCurve& c : curves)
    print("{:{}}  {:10}  {:9.2e}  {:11.3f}  {:10.3f}{}\n", c.solver, widest, c.iterations(), c.lastResidual(),
          1e3 * c.setupSeconds, 1e3 * c.solveSeconds, c.outcome == "converged" ? "" : "  " + c.outcome);
}

void compareSolvers(const Case& c, AnySimulation simulation, const std::vector<SolverSettings>& solvers,
                    const fs::path& directory) {
  advanceToEnd(c, simulation);
  const std::string where = fmt::format("step {}, from t = {:.6g} s", simulation.step() + 1, simulation.time());
  std::vector<ConvergenceCurve> curves;
  for (SolverTrial& trial : simulation.convergence(solvers))
    curves.push_back({std::move(trial.solver), outcomeText(trial.report.status), std::move(trial.residuals),
                      trial.setupSeconds, trial.solveSeconds});
  numberEqualNames(curves);
  print("{}: {}, {} fluid particles\n", c.title.empty() ? "case" : c.title, where, simulation.numbers().fluid);
  printTable(curves);
  writeConvergence(directory / "convergence.csv", curves);
  writeSolvers(directory / "solvers.csv", curves);
  // What was compared is told, and is in the tables.
  if (!tryDrawCurves(directory, directory / "convergence.png",
                     {"--convergence", "--title=" + c.title, "--remark=" + where}))
    printWarning("convergence.png was not drawn");
}

fs::path directoryOf(const ConvergenceOptions& options) {
  const fs::path path =
      options.directory.empty() ? options.input.file.stem().concat("-convergence") : options.directory;
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && !fs::is_directory(path)) error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    throw InputError(fmt::format("output directory {}: cannot be created: {}", path.string(), error.message()));
  return path;
}

}  // namespace

void convergenceCommand(const ConvergenceOptions& options) {
  const Patience patience("comparing the solvers");
  const std::optional<DeviceInfo> device = deviceFor(options.backend);
  startThreads(options.threads);
  Case c = readCase(options.input.file, overridesOf(options));
  const std::vector<SolverSettings> solvers = comparedSolvers(options, c.method.kind);
  std::vector<std::string> warnings;
  requireRoomForParticles(c);
  MadeParticles made = withPlaces(options.input, [&] { return MadeParticles::of(c, warnings); });
  if (options.resume.empty()) made.requireParticles(c);
  for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  if (!device)
    for (std::string& warning : cpuWarnings(c)) warnings.push_back(std::move(warning));
  Case until = c;
  StartState start = startOf(until, options, std::move(made));
  for (Case with = c; const SolverSettings& solver : solvers) {
    with.solver = solver;
    requireMemory(with, start.particles, device ? &*device : nullptr);
  }
  if (c.time.stepsVary() && until.time.end > 0) c.time.end = until.time.end;  // the last step is to meet it
  const fs::path directory = directoryOf(options);
  for (const std::string& warning : warnings) printWarning(warning);
  print("{}\n",
        device ? deviceText(*device) : fmt::format("{}, {} threads", processorName(), omp_get_max_threads()));
  const BackendKind backend = device ? BackendKind::Cuda : BackendKind::Cpu;
  compareSolvers(until, AnySimulation(c, std::move(start.particles), backend, start.step, start.time), solvers,
                 directory);
}

}  // namespace treacle
