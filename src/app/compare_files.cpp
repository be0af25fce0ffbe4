#include "compare_files.hpp"

#include "compare_tables.hpp"
#include "print.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/compare/compare_sets.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/particle_csv.hpp"
#include "treacle/io/frames/pvtp.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace treacle {
namespace {

constexpr double sameTime = 1e-9;  // of the last frame's: the rounding of times

/// A or B.
struct Side {
  std::string name;  // of the file with the particles
  Frame frame;
  std::size_t number = 0;  // of the frame in its run; 0 of a CSV file
};

/// The run among A and B, if there is one.
struct ComparedRun {
  Case reference;
  double time = 0;  // [s] of the frame
  Side side;
};

/// All of them, or the first and last ones where they are many.
std::string frameTimes(const RunDirectory& run) {
  constexpr std::size_t ends = 10;
  std::string list;
  for (std::size_t k = 0; k < run.frameCount(); ++k) {
    const bool inner = k >= ends && k + ends < run.frameCount();
    if (inner && k > ends) continue;
    list += fmt::format("{}{}", k == 0 ? "" : ", ", inner ? "..." : fmt::format("{:.6g}", run.frameTime(k)));
  }
  return list;
}

/// The frame nearest to the time, within half the interval between frames; by default the last one.
std::size_t chosenFrame(const RunDirectory& run, const std::optional<double>& time, double interval) {
  if (run.frameCount() == 0) throw InputError(fmt::format("{}: the run has no frames", run.path().string()));
  const std::size_t last = run.frameCount() - 1;
  if (!time) return last;
  const auto distance = [&](std::size_t k) { return std::abs(run.frameTime(k) - *time); };
  std::size_t nearest = 0;
  for (std::size_t k = 1; k <= last; ++k)
    if (distance(k) < distance(nearest)) nearest = k;
  if (distance(nearest) > interval / 2 + sameTime * run.frameTime(last))
    throw InputError(fmt::format("--time {:g}: {} has no frame near it; expected one of t [s]: {}", *time,
                                 run.path().string(), frameTimes(run)));
  return nearest;
}

ComparedRun readRun(const std::filesystem::path& path, const std::optional<double>& time) {
  const RunDirectory run = RunDirectory::open(path);
  Case reference = readCase(run.caseFile(), {}, ShapeFiles::Leave);
  const std::size_t number = chosenFrame(run, time, reference.output.interval);
  const auto file = run.fluidFrame(number);
  return {std::move(reference), run.frameTime(number), {file.string(), readFrame(file), number}};
}

Side readFile(const std::filesystem::path& path, const std::optional<ComparedRun>& run) {
  return {path.string(), readParticleCsv(path, run ? std::optional(run->reference.dimensions) : std::nullopt)};
}

struct Comparison {
  RunDifference difference;          // of one frame
  std::vector<SetMeasure> measures;  // empty: particles were matched
};

Comparison compared(const Side& a, const Side& b, const Case& reference, double time) {
  const bool matched = !a.frame.id.empty() && !b.frame.id.empty();
  Comparison c;
  FrameDifference& frame = c.difference.frames.emplace_back();
  try {
    if (matched) {
      frame = compareFrames(a.frame, b.frame, reference);
    } else {
      SetDifference sets = compareSets(a.frame, b.frame, reference);
      frame = sets.nearest;
      c.measures = std::move(sets.measures);
    }
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} and {} cannot be compared: {}{}", a.name, b.name, e.what(),
                                 matched ? "; without a column 'id' they are compared as sets" : ""));
  }
  frame.time = time;
  frame.frameA = a.number, frame.frameB = b.number;
  return c;
}

void requireFields(const FrameDifference& frame, const Side& a, const Side& b,
                   std::span<const ComparedField> fields) {
  for (const ComparedField field : fields)
    if (!frame[field])
      throw InputError(
          fmt::format("{} and {}: '{}' is not in both of them; expected columns of it, or other fields by --field",
                      a.name, b.name, nameOf(field)));
}

void printTable(const Comparison& c, const Side& a, const Side& b, bool timed) {
  print("A: {}, {} particles\nB: {}, {} particles\n", a.name, a.frame.position.size(), b.name,
        b.frame.position.size());
  if (timed) print("frame at t = {:.6g} s\n", c.difference.frames.front().time);
  if (c.measures.empty())
    printFrames(c.difference.frames);
  else
    printMeasures(c.measures);
}

void writeTable(const Comparison& c, const std::filesystem::path& path) {
  if (c.measures.empty())
    writeFrameDifferences(path, c.difference.frames);
  else
    writeSetMeasures(path, c.measures);
}

void printVerdict(const FrameDifference& frame, const CompareOptions& options,
                  const std::optional<Excess>& excess) {
  if (excess)
    print("differ: {} by {:.2e}, bound {:g}\n", nameOf(excess->field), frame[excess->field]->relative,
          options.bound);
  else
    print("agree within {:g}: {}\n", options.bound, listOf(options.fields));
}

}  // namespace

bool isParticleFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

bool compareFiles(const CompareOptions& options) {
  std::optional<ComparedRun> run;
  for (const auto& path : {options.a, options.b})
    if (!isParticleFile(path)) run = readRun(path, options.time);
  if (!run && options.time)
    throw InputError("--time: neither A nor B is a run; expected one to take a frame from");
  const Side a = isParticleFile(options.a) ? readFile(options.a, run) : std::move(run->side);
  const Side b = isParticleFile(options.b) ? readFile(options.b, run) : std::move(run->side);
  const Comparison c = compared(a, b, run ? run->reference : Case{}, run ? run->time : 0);
  const FrameDifference& frame = c.difference.frames.front();
  requireFields(frame, a, b, options.fields);
  const std::optional<Excess> excess = firstExcess(c.difference, options.fields, options.bound);
  if (!options.quiet) printTable(c, a, b, run.has_value());
  if (!options.csv.empty()) writeTable(c, options.csv);
  printVerdict(frame, options, excess);
  return !excess;
}

}  // namespace treacle
