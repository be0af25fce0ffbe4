// Solves the pressure equation of ISPH, from the same first guess to the same tolerance, by the paper's MGCG(m, n)
// as plain calls of cuSPARSE and cuBLAS and by treacle's own solvers, and times the phases of steps, on one GPU;
// writes one JSON record.
//   isph_benchmark [--out FILE.json] [--cases DIR] [--case FILE] [--set KEY=VALUE]... [--widths W...] [--steps N]
//                  [--timed-steps N] [--checkpoint FILE] [--only TEXT] [--solver "KEY=VALUE ..."]...
//   isph_benchmark --largest FLUID_PARTICLES [...]
// Systems: the case at every width (factor of its [width]) after --steps steps; or the checkpoint of a run, with
// --case or case.toml beside it. --largest: steps alone, of the case as wide as so many particles need. Names are
// SYSTEM/METHOD. Figures of one run belong together: compare them as ratios. Exit code: 0, 1 when a method failed,
// 2 bad input.

#include "isph_methods.hpp"
#include "isph_phases.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/model/particles/create.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace treacle {
namespace {

template <int D>
void compare(const IsphOptions& options, const std::string& name, const Case& c, const Particles<D>& state,
             double timeStep, SolveRecord& record) {
  IsphPressureSystem<D> system(c, state, timeStep);
  IsphComparison<D> comparison(options, name, system, record);
  for (const IsphLibraryVariant& v : libraryVariants) comparison.runLibrary(v);
  for (const std::string& s : options.solvers.empty() ? defaultSolvers : options.solvers) comparison.runTreacle(s);
}

/// The state after the steps; the phases are those of the steps that follow, after one that may still allocate.
template <int D>
void runCase(const IsphOptions& options, const Case& c, double width, SolveRecord& record) {
  const std::string name =
      fmt::format("{}D {}step {}", D, width > 0 ? fmt::format("width {:g} ", width) : "", options.steps + 1);
  guarded(name, record, [&] {
    std::vector<std::string> notes;
    AnyParticles state(D);
    double timeStep = c.time.step;
    {
      AnySimulation simulation(c, createParticles(c, notes), BackendKind::Cuda);
      while (simulation.step() < options.steps) timeStep = simulation.advance().timeStep;
      simulation.copyParticles(state);
      if (options.timedSteps > 0) {
        simulation.advance();
        timePhases(simulation, name, options.timedSteps, record);
      }
    }
    compare<D>(options, name, c, state.of<D>(), timeStep, record);
  });
}

template <int D>
void runCheckpoint(const IsphOptions& options, const Case& c, SolveRecord& record) {
  guarded("checkpoint", record, [&] {
    const Checkpoint<D> state = readCheckpoint<D>(options.checkpoint);
    const std::string name = fmt::format("{}D checkpoint {:.4g} s", D, state.time);
    if (options.timedSteps > 0) {
      Checkpoint<D> again = readCheckpoint<D>(options.checkpoint);
      AnySimulation simulation(c, std::move(again.particles), BackendKind::Cuda, state.step, state.time);
      simulation.advance();
      timePhases(simulation, name, options.timedSteps, record);
    }
    compare<D>(options, name, c, state.particles, c.time.step, record);
  });
}

/// Widens the case until it has the particles asked for.
void runLargest(const IsphOptions& options, SolveRecord& record) {
  std::vector<std::string> notes;
  const Case narrow = options.readCaseAt(1);
  const double perWidth = static_cast<double>(createParticles(narrow, notes).numbers().fluid);
  const double width = std::max(1.0, std::round(options.particles / perWidth));
  const std::string name = fmt::format("{}D width {:g}", narrow.dimensions, width);
  guarded(name, record, [&] {
    const Case c = options.readCaseAt(width);
    AnySimulation simulation(c, createParticles(c, notes), BackendKind::Cuda);
    simulation.advance();
    timePhases(simulation, name, std::max(options.timedSteps, 1), record);
  });
}

void run(const IsphOptions& options, SolveRecord& record) {
  record.heading();
  const Case first = options.readCaseAt(0);
  if (first.method.kind != MethodKind::Isph) throw InputError(options.caseFile + ": not a case of ISPH");
  const bool flat = first.dimensions == 2;
  if (options.particles > 0) return runLargest(options, record);
  if (!options.checkpoint.empty())
    return flat ? runCheckpoint<2>(options, first, record) : runCheckpoint<3>(options, first, record);
  for (const double width : options.widths.empty() ? std::vector<double>{0} : options.widths) {
    const Case c = options.readCaseAt(width);
    flat ? runCase<2>(options, c, width, record) : runCase<3>(options, c, width, record);
  }
}

/// What the figures are, for readers of the record.
const char* const counted =
    "setup_ms: libraries: matrix_ms (compressed rows from the cell ranges), cell levels, 1 / A_ii, transfers, "
    "coarse operators by SpGEMM, SpMV analyses; treacle: matrix_ms (coefficients on the step's neighbour rows, "
    "which belong to the lists), preconditioner. solve_ms: all from the first guess on, the recording of the loop "
    "included; iterations_ms: libraries without the recording, treacle iterations times what one costs more. "
    "bytes_per_iteration: every kernel reads and writes what it needs once; small systems stay in the cache.";

}  // namespace
}  // namespace treacle

int main(int argc, char** argv) {
  using namespace treacle;
  CLI::App app{"Compares solvers of ISPH's pressure equation on the GPU"};
  IsphOptions options;
  options.cases = TREACLE_CASES;
  std::string out;
  app.add_option("--out", out, "JSON record");
  app.add_option("--cases", options.cases, "directory of the default case");
  app.add_option("--case", options.caseFile, "default: isph-dam-break.toml, or case.toml beside the checkpoint");
  app.add_option("--set", options.settings, "KEY=VALUE on top of the case");
  app.add_option("--widths", options.widths, "factors of the case's [width]")->check(CLI::PositiveNumber);
  app.add_option("--steps", options.steps, "steps before the system is taken")->check(CLI::NonNegativeNumber);
  app.add_option("--timed-steps", options.timedSteps, "steps of which the phases are timed (0: none)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--checkpoint", options.checkpoint, "a late state of a run")->check(CLI::ExistingFile);
  app.add_option("--only", options.only, "only SYSTEM/METHOD names that contain this");
  app.add_option("--solver", options.solvers, "settings of treacle's solver, instead of the default list");
  app.add_option("--largest", options.particles, "only steps, with so many fluid particles")
      ->check(CLI::PositiveNumber);
  app.add_option("--repetitions", options.repetitions, "timed solves, after one to warm up")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  if (options.caseFile.empty())
    options.caseFile = options.checkpoint.empty()
                           ? options.cases + "/isph-dam-break.toml"
                           : (std::filesystem::path(options.checkpoint).parent_path() / "case.toml").string();

  const auto devices = cudaDevices();
  if (devices.empty()) {
    fmt::print(stderr, "isph_benchmark: no CUDA device on this machine\n");
    return 2;
  }
  SolveRecord record;
  const BuildInfo build = buildInfo();
  record.copyBandwidth = copyBandwidth();
  record.json = {{"commit", build.commit},
                 {"compiler", build.compiler},
                 {"device", devices[0].name},
                 {"copy_bandwidth_GB_per_s", record.copyBandwidth * 1e-9},
                 {"counted", counted}};
  fmt::print("{}, copy {:.2f} TB/s\n", devices[0].name, record.copyBandwidth * 1e-12);
  try {
    run(options, record);
  } catch (const std::exception& error) {
    fmt::print(stderr, "isph_benchmark: {}\n", error.what());
    return 2;
  }
  if (!out.empty()) std::ofstream(out) << record.json.dump(1) << '\n';
  return record.failed ? 1 : 0;
}
