#include "treacle/io/compare.hpp"
#include "commands.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

void printFrames(const RunDifference& difference) {
  fmt::print("{:>12}", "");
  for (const char* field : {"position [m]", "velocity [m/s]", "pressure [Pa]", "number density"})
    fmt::print("  {:>27}", field);
  fmt::print("\n{:>12}", "t [s]");
  for (std::size_t k = 0; k < comparedFieldCount; ++k) fmt::print("  {:>9}{:>9}{:>9}", "max", "rms", "relative");
  fmt::print("\n");
  for (const FrameDifference& frame : difference.frames) {
    fmt::print("{:12.6g}", frame.time);
    for (const auto& d : frame.fields)
      if (d)
        fmt::print("  {:9.2e}{:9.2e}{:9.2e}", d->maximum, d->rms, d->relative);
      else
        fmt::print("  {0:>9}{0:>9}{0:>9}", "-");
    fmt::print("\n");
  }
}

void printUnmatched(const std::filesystem::path& run, const std::vector<double>& times) {
  if (times.empty()) return;
  fmt::print("frames of {} without a partner, t [s]:", run.string());
  for (const double time : times) fmt::print(" {:.6g}", time);
  fmt::print("\n");
}

void printHistory(const HistoryDifference& h) {
  if (h.rows == 0) {
    fmt::print("histories: no time step in both\n");
    return;
  }
  fmt::print("histories: {} time steps in both\n", h.rows);
  fmt::print("  iterations, mean: {:.2f} and {:.2f}; largest difference in the first 10 steps: {}\n",
             h.meanIterationsA, h.meanIterationsB, h.earlyIterations);
  fmt::print("  relative differences at t = {:.6g} s: front_x {:.2e}, top {:.2e}, kinetic_energy {:.2e}\n", h.time,
             h.frontX, h.top, h.kineticEnergy);
}

void printVerdict(const RunDifference& difference, const CompareOptions& options,
                  const std::optional<Excess>& excess) {
  if (excess) {
    const FrameDifference& frame = difference.frames[excess->index];
    fmt::print("differ: {} by {:.2e} at t = {:.6g} s (frames {} and {}), bound {:g}\n", nameOf(excess->field),
               frame[excess->field]->relative, frame.time, frame.frameA, frame.frameB, options.bound);
    return;
  }
  std::string fields;
  for (const ComparedField field : options.fields)
    fields += fmt::format("{}{}", fields.empty() ? "" : ", ", nameOf(field));
  fmt::print("agree within {:g} in {} frames: {}\n", options.bound, difference.frames.size(), fields);
}

}  // namespace

bool compareCommand(const CompareOptions& options) {
  const RunDirectory a = RunDirectory::open(options.a), b = RunDirectory::open(options.b);
  const RunDifference difference = compareRuns(a, b);
  const std::optional<Excess> excess = firstExcess(difference, options.fields, options.bound);
  if (!options.quiet) {
    printFrames(difference);
    printUnmatched(options.a, difference.onlyInA);
    printUnmatched(options.b, difference.onlyInB);
    printHistory(difference.history);
  }
  if (!options.csv.empty()) writeFrameDifferences(options.csv, difference.frames);
  printVerdict(difference, options, excess);
  return !excess;
}

}  // namespace treacle
