// Solves the same linear systems, from the same first guess to the same tolerance, by the papers' algorithms as
// plain calls of cuSPARSE and cuBLAS and by treacle's own solvers, on one GPU; writes one JSON record.
//   solve_benchmark [--out FILE.json] [--cases DIR] [--states DIR] [--checkpoint FILE [--case FILE]] [--only TEXT]
//                   [--sizes2 R... --sizes3 R...] [--largest RESOLUTION] [--steps N] [--solver "KEY=VALUE ..."]...
// Systems: every file of study_state.py in --states; the checkpoint of a run; the first step of the papers' dam
// breaks (with --steps: a later one). Names are SYSTEM/METHOD. Figures of one run belong together: compare them as
// ratios. Exit code: 0, 1 when a method failed, 2 bad input.

#include "solve_methods.hpp"
#include "studied_system.hpp"
#include "study_state.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

#include <CLI/CLI.hpp>

#include <fstream>
#include <set>

namespace treacle {
namespace {

std::vector<std::string> solversOf(const SolveOptions& options) {
  return options.solvers.empty() ? defaultSolvers : options.solvers;
}

bool wantsSystem(const SolveOptions& options, const std::string& name) {
  for (const LibraryVariant& v : libraryVariants)
    if (options.wants(name + "/" + v.name)) return true;
  for (const std::string& s : solversOf(options))
    if (options.wants(name + "/" + solverName(s))) return true;
  return false;
}

template <int D>
void compare(const SolveOptions& options, const std::string& name, StudiedSystem<D, Cuda>& system,
             SolveRecord& record) {
  SolveComparison<D> comparison(options, name, system, record);
  for (const LibraryVariant& v : libraryVariants) comparison.runLibrary(v);
  for (const std::string& s : solversOf(options)) comparison.runTreacle(s);
}

/// The right-hand side must be the study's: else this is not its system. Its elastic part is a difference of
/// nearly equal densities times kappa, which leaves 1e-10 of the rounding.
template <int D>
void checkRightHandSide(StudiedSystem<D, Cuda>& system, const StudyState& s) {
  Buffer<Vec<D>> b;
  Buffer<std::uint32_t> id;
  copyToHost(system.context, system.rightHandSide(), b);
  copyToHost(system.context, std::span<const std::uint32_t>(system.particles.id.span()), id);
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    for (int k = 0; k < D; ++k) {
      const double theirs = s.rightHandSide[std::size_t{id[i]} * D + static_cast<std::size_t>(k)];
      difference += (b[i][k] - theirs) * (b[i][k] - theirs);
      sum += theirs * theirs;
    }
  if (!(difference <= 1e-18 * sum))
    throw RunError(
        fmt::format("the right-hand side differs from the file's by {:.1e}", std::sqrt(difference / sum)));
}

template <int D>
void runState(const SolveOptions& options, const std::string& name, const StudyState& s, SolveRecord& record) {
  const Case c = paperCase(options, D, 1e-3 / s.spacing);
  if (std::abs(c.time.step - s.timeStep) > 1e-9 * s.timeStep)
    throw InputError(fmt::format("time step {} s, that of the case is {} s", s.timeStep, c.time.step));
  StudiedSystem<D, Cuda> system(c, particlesOf<D>(s));
  checkRightHandSide(system, s);
  compare(options, name, system, record);
}

void runStates(const SolveOptions& options, SolveRecord& record) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(options.states))
    if (entry.path().extension() == ".state") files.insert(entry.path());
  if (files.empty()) throw InputError(options.states + ": no .state files; study_state.py makes them");
  for (const auto& path : files) {
    const std::string name = "study " + path.stem().string();
    if (!wantsSystem(options, name)) continue;
    guarded(name, record, [&] {
      const StudyState s = readStudyState(path);
      s.dimensions == 2 ? runState<2>(options, name, s, record) : runState<3>(options, name, s, record);
    });
  }
}

template <int D>
void runCheckpoint(const SolveOptions& options, Case c, SolveRecord& record) {
  c.solver = {};  // matrices need lists
  Checkpoint<D> state = readCheckpoint<D>(options.checkpoint);
  const std::string name = fmt::format("{}D checkpoint {:.4g} s", D, state.time);
  const Particles<D>& p = state.particles;
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i)
    if (norm2(p.velocity[i]) > 0) throw InputError(options.checkpoint + ": walls that move are not compared");
  StudiedSystem<D, Cuda> system(c, std::move(state.particles));
  compare(options, name, system, record);
}

template <int D>
void runDamBreak(const SolveOptions& options, double resolution, SolveRecord& record) {
  const std::string name = fmt::format("{}D x1/{:g} step {}", D, resolution, options.steps + 1);
  if (!wantsSystem(options, name)) return;
  guarded(name, record, [&] {
    const Case c = paperCase(options, D, resolution);
    std::vector<std::string> notes;
    Particles<D> particles = createParticles<D>(c, notes);
    if (options.steps > 0) {
      Simulation<D, Cuda> simulation(c, std::move(particles));
      while (simulation.step() < options.steps) simulation.advance();
      particles = {};
      simulation.copyParticles(particles);
    }
    StudiedSystem<D, Cuda> system(c, std::move(particles));
    compare(options, name, system, record);
  });
}

void run(const SolveOptions& options, SolveRecord& record) {
  record.heading();
  if (options.largest > 0) return runDamBreak<3>(options, options.largest, record);
  if (!options.states.empty()) runStates(options, record);
  if (!options.checkpoint.empty()) {
    guarded("checkpoint", record, [&] {
      const std::filesystem::path beside = std::filesystem::path(options.checkpoint).parent_path() / "case.toml";
      const Case c = readCase(options.checkpointCase.empty() ? beside.string() : options.checkpointCase);
      c.dimensions == 2 ? runCheckpoint<2>(options, c, record) : runCheckpoint<3>(options, c, record);
    });
  }
  for (const double r : options.sizes2) runDamBreak<2>(options, r, record);
  for (const double r : options.sizes3) runDamBreak<3>(options, r, record);
}

}  // namespace
}  // namespace treacle

int main(int argc, char** argv) {
  using namespace treacle;
  CLI::App app{"Compares solvers on the GPU"};
  SolveOptions options;
  options.cases = TREACLE_CASES;
  options.sizes2 = {1, 4, 8, 16, 32};
  options.sizes3 = {1, 2, 4};
  std::string out;
  app.add_option("--out", out, "JSON record");
  app.add_option("--cases", options.cases, "directory of the case files");
  app.add_option("--scheme", options.scheme, "of the dam breaks, published unless told");
  app.add_option("--states", options.states, "directory of files of study_state.py")
      ->check(CLI::ExistingDirectory);
  app.add_option("--checkpoint", options.checkpoint, "a late state of a run")->check(CLI::ExistingFile);
  app.add_option("--case", options.checkpointCase, "its case; default: case.toml beside it");
  app.add_option("--only", options.only, "only SYSTEM/METHOD names that contain this");
  app.add_option("--sizes2", options.sizes2, "resolutions of the 2D dam break (0: none)");
  app.add_option("--sizes3", options.sizes3, "resolutions of the 3D dam break (0: none)");
  app.add_option("--largest", options.largest, "only the 3D dam break at this resolution");
  app.add_option("--steps", options.steps, "steps that the dam breaks are run first");
  app.add_option("--solver", options.solvers, "settings of treacle's solver, instead of the default list");
  app.add_option("--repetitions", options.repetitions, "timed solves, after one to warm up")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  for (auto* sizes : {&options.sizes2, &options.sizes3}) std::erase(*sizes, 0.0);

  const auto devices = cudaDevices();
  if (devices.empty()) {
    fmt::print(stderr, "solve_benchmark: no CUDA device on this machine\n");
    return 2;
  }
  SolveRecord record;
  const BuildInfo build = buildInfo();
  record.json = {{"commit", build.commit},
                 {"compiler", build.compiler},
                 {"device", devices[0].name},
                 {"scheme", options.scheme}};
  try {
    run(options, record);
  } catch (const std::exception& error) {
    fmt::print(stderr, "solve_benchmark: {}\n", error.what());
    return 2;
  }
  if (!out.empty()) std::ofstream(out) << record.json.dump(1) << '\n';
  return record.failed ? 1 : 0;
}
