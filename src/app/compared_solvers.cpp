#include "compared_solvers.hpp"

#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/names.hpp"

#include <fmt/format.h>

#include <sstream>

namespace treacle {
namespace {

std::vector<std::string> defaultsOf(MethodKind method) {
  if (method == MethodKind::Isph)
    return {"preconditioner=none", "preconditioner=cell-multigrid cells.levels=1",
            "preconditioner=cell-multigrid cells.levels=2", "preconditioner=cell-multigrid cells.levels=0",
            "preconditioner=hat-multigrid"};
  return {"krylov=cr preconditioner=none", "krylov=cg preconditioner=none",
          "krylov=cr preconditioner=bucket-multigrid precision=double",
          "krylov=cg preconditioner=projected-multigrid precision=double", ""};
}

/// What all solvers of a comparison share: the system is made, and its first guess, before they are.
void refuseShared(const std::string& word) {
  for (const char* key : {"neighbours", "first_guess"})
    if (word.starts_with(key) && word.substr(std::string_view(key).size()).starts_with('='))
      throw InputError(fmt::format(
          "{0}: is the same for all solvers of a comparison; change it in the case, --set solver.{1}", key, word));
}

/// The reader speaks of the --set that an override looks like to it.
std::string withoutSet(std::string message, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides)
    if (const std::string place = "--set " + text + ": "; message.starts_with(place))
      return message.substr(place.size());
  return message;
}

SolverSettings read(const ConvergenceOptions& options, const std::string& keys) {
  std::vector<std::string> overrides = overridesOf(options), own;
  try {
    std::istringstream words(keys);
    for (std::string word; words >> word;) {
      refuseShared(word);
      own.push_back("solver." + word);
    }
    overrides.insert(overrides.end(), own.begin(), own.end());
    return readCase(options.input.file, overrides).solver;
  } catch (const InputError& error) {
    throw InputError(fmt::format("--solver \"{}\": {}", keys, withoutSet(error.what(), own)));
  }
}

}  // namespace

std::vector<std::string> overridesOf(const ConvergenceOptions& options) {
  std::vector<std::string> overrides = options.input.overrides;
  if (options.precision) overrides.push_back(fmt::format("solver.precision={}", nameOf(*options.precision)));
  return overrides;
}

std::vector<SolverSettings> comparedSolvers(const ConvergenceOptions& options, MethodKind method) {
  std::vector<SolverSettings> solvers;
  for (const std::string& keys : options.solvers.empty() ? defaultsOf(method) : options.solvers)
    solvers.push_back(read(options, keys));
  return solvers;
}

}  // namespace treacle
