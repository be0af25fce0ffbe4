#include "treacle/io/compare/compare.hpp"
#include "commands.hpp"
#include "compare_files.hpp"
#include "compare_tables.hpp"
#include "patience.hpp"
#include "print.hpp"
#include "threads.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

void printUnmatched(const std::filesystem::path& run, const std::vector<double>& times) {
  if (times.empty()) return;
  print("frames of {} without a partner, t [s]:", run.string());
  for (const double time : times) print(" {:.6g}", time);
  print("\n");
}

void printHistory(const HistoryDifference& h) {
  if (h.rows == 0) {
    print("histories: no time step in both\n");
    return;
  }
  print("histories: {} time steps in both\n", h.rows);
  print("  iterations, mean: {:.2f} and {:.2f}; largest difference in the first 10 steps: {}\n", h.meanIterationsA,
        h.meanIterationsB, h.earlyIterations);
  print("  relative differences at t = {:.6g} s: front_x {:.2e}, top {:.2e}, kinetic_energy {:.2e}\n", h.time,
        h.frontX, h.top, h.kineticEnergy);
}

void printVerdict(const RunDifference& difference, const CompareOptions& options,
                  const std::optional<Excess>& excess) {
  if (excess) {
    const FrameDifference& frame = difference.frames[excess->index];
    print("differ: {} by {:.2e} at t = {:.6g} s (frames {} and {}), bound {:g}\n", nameOf(excess->field),
          frame[excess->field]->relative, frame.time, frame.frameA, frame.frameB, options.bound);
    return;
  }
  print("agree within {:g} in {} frames: {}\n", options.bound, difference.frames.size(), listOf(options.fields));
}

}  // namespace

bool compareCommand(const CompareOptions& options) {
  const Patience patience("comparing", options.quiet);
  startThreads(0);
  if (!options.csv.empty()) RunDirectory::requireForeign(options.csv, "--csv");
  if (isParticleFile(options.a) || isParticleFile(options.b)) return compareFiles(options);
  if (options.time)
    throw InputError("--time: two runs are compared at all times that they share; expected a CSV file as A or B");
  const RunDirectory a = RunDirectory::open(options.a), b = RunDirectory::open(options.b);
  const RunDifference difference = compareRuns(a, b);
  const std::optional<Excess> excess = firstExcess(difference, options.fields, options.bound);
  if (!options.quiet) {
    printFrames(difference.frames);
    printUnmatched(options.a, difference.onlyInA);
    printUnmatched(options.b, difference.onlyInB);
    printHistory(difference.history);
  }
  if (!options.csv.empty()) writeFrameDifferences(options.csv, difference.frames);
  printVerdict(difference, options, excess);
  return !excess;
}

}  // namespace treacle
