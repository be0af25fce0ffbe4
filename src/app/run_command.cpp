#include "backend.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "resume.hpp"
#include "run.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/checks.hpp"
#include "treacle/model/create.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <optional>

namespace treacle {
namespace {

Case caseOf(const RunOptions& options) {
  Case c = readCase(options.input.file, options.input.overrides);
  if (options.precision) c.solver.precision = *options.precision;
  if (options.endTime) {
    c.time.end = *options.endTime;
    if (!c.time.stepsVary() && c.steps() < 1)
      throw InputError(
          fmt::format("--end-time: expected at least one step of {:g} s, found {:g}", c.time.step, c.time.end));
  }
  return c;
}

/// --force would remove the checkpoint before another one exists.
void requireElsewhere(const std::filesystem::path& directory, const std::filesystem::path& checkpoint) {
  using std::filesystem::weakly_canonical;
  if (!checkpoint.empty() && weakly_canonical(checkpoint).parent_path() == weakly_canonical(directory))
    throw InputError(fmt::format("--resume {}: lies in the run directory; choose another one with --output",
                                 checkpoint.string()));
}

}  // namespace

void runCommand(const RunOptions& options) {
  const std::optional<DeviceInfo> device = deviceFor(options.backend);
  if (options.threads > 0) omp_set_num_threads(options.threads);
  const Case c = caseOf(options);
  std::vector<std::string> warnings;
  StartState start{createParticles(c, warnings)};
  for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  requireMemory(c, start.particles.numbers(), device ? &*device : nullptr);
  const auto directory = options.directory.empty() ? options.input.file.stem().concat("-run") : options.directory;
  requireElsewhere(directory, options.resume);
  if (!options.resume.empty()) start = resumedState(c, options.resume, start.particles);
  catchInterrupts();
  RunDirectory files = RunDirectory::create(directory, options.force);
  if (!device)
    for (std::string& warning : cpuWarnings(c)) warnings.push_back(std::move(warning));
  Run run(c, std::move(start), device ? BackendKind::Cuda : BackendKind::Cpu, std::move(files), options,
          device ? deviceText(*device) : processorName());
  run.execute(warnings);
}

}  // namespace treacle
