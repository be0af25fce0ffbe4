#include "commands.hpp"
#include "memory.hpp"
#include "print.hpp"
#include "run_log.hpp"
#include "threads.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/atomic_file.hpp"
#include "treacle/io/import_case.hpp"
#include "treacle/model/checks.hpp"
#include "treacle/model/create.hpp"

#include <fmt/format.h>

#include <memory>
#include <system_error>

namespace treacle {
namespace {

namespace fs = std::filesystem;

/// Errors: InputError where it is one of those that are read, or there and not to be replaced.
void requireWritable(const fs::path& path, const ImportOptions& options) {
  std::error_code error;
  for (const fs::path& input : {options.parameters, options.geometry})
    if (fs::equivalent(path, input, error))
      throw InputError(fmt::format("{}: would replace a file that is imported; choose another one with --output",
                                   path.string()));
  const bool isFile = fs::is_regular_file(path, error);  // and no device
  if (isFile && !options.force)
    throw InputError(fmt::format("{}: is already there; --force replaces it", path.string()));
}

/// All of them are complete before the first one appears under its name; the case comes last.
void write(const ImportedCase& imported, const fs::path& output, const ImportOptions& options) {
  std::vector<std::pair<fs::path, const std::string*>> contents;
  for (const ParticleTable& table : imported.tables)
    contents.emplace_back(output.parent_path() / table.name, &table.content);
  contents.emplace_back(output, &imported.text);
  for (const auto& [path, content] : contents) requireWritable(path, options);
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (const auto& [path, content] : contents) {
    files.push_back(std::make_unique<AtomicFile>(path));
    files.back()->write(*content);
  }
  for (const auto& file : files) file->commit();
  for (const auto& [path, content] : contents) print("{}\n", path.string());
}

/// Of the particles, which are made as a run will make them. Errors: InputError where it could not, RunError where
/// there is not enough memory.
ParticleNumbers numbersOf(ImportedCase& imported, const fs::path& geometry) try {
  if (const double count = boxPoints(imported.value); count > static_cast<double>(maxParticles))
    throw InputError(
        fmt::format("the case would have {:.3g} particles, more than the limit of {}", count, maxParticles));
  requireRoomForParticles(imported.value);
  return createParticles(imported.value, imported.warnings).numbers();
} catch (const InputError& error) {
  throw InputError(fmt::format("{}: {}", geometry.string(), error.what()));
}

}  // namespace

void importCommand(const ImportOptions& options) {
  startThreads(0);
  const fs::path output =
      options.output.empty() ? fs::path(options.parameters.stem().string() + ".toml") : options.output;
  ImportedCase imported = importCase(options.parameters, options.geometry, output);
  const ParticleNumbers numbers = numbersOf(imported, options.geometry);
  for (std::string& warning : caseWarnings(imported.value)) imported.warnings.push_back(std::move(warning));
  write(imported, output, options);
  print("{} dimensions, {} fluid and {} wall particles\n", imported.value.dimensions, numbers.fluid, numbers.wall);
  flushPrinted();
  for (const std::string& warning : imported.warnings) printWarning(warning);
}

}  // namespace treacle
