#include "treacle/io/compare/compare.hpp"

#include "relative.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/io/frames/pvtp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

namespace treacle {
namespace {

constexpr double sameTime = 1e-9;  // of the end: more than the rounding of step * dt, less than a time step
constexpr std::size_t earlyRows = 10;

struct TimeMatch {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::size_t> onlyA, onlyB;
};

/// Both ascending.
TimeMatch matchTimes(const std::vector<double>& a, const std::vector<double>& b) {
  TimeMatch match;
  const double tolerance = a.empty() || b.empty() ? 0 : sameTime * std::max(a.back(), b.back());
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (std::abs(a[i] - b[j]) <= tolerance)
      match.pairs.emplace_back(i++, j++);
    else if (a[i] < b[j])
      match.onlyA.push_back(i++);
    else
      match.onlyB.push_back(j++);
  }
  while (i < a.size()) match.onlyA.push_back(i++);
  while (j < b.size()) match.onlyB.push_back(j++);
  return match;
}

std::vector<double> frameTimes(const RunDirectory& run) {
  std::vector<double> times;
  for (std::size_t k = 0; k < run.frameCount(); ++k) times.push_back(run.frameTime(k));
  return times;
}

std::vector<double> rowTimes(std::span<const HistoryRow> rows) {
  std::vector<double> times;
  for (const HistoryRow& row : rows) times.push_back(row.time);
  return times;
}

FrameDifference compareFrameFiles(const RunDirectory& a, const RunDirectory& b, std::size_t frameA,
                                  std::size_t frameB, const Case& reference) {
  const auto pathA = a.fluidFrame(frameA), pathB = b.fluidFrame(frameB);
  const Frame first = readFrame(pathA), second = readFrame(pathB);
  try {
    FrameDifference d = compareFrames(first, second, reference);
    d.time = b.frameTime(frameB);
    d.frameA = frameA, d.frameB = frameB;
    return d;
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} and {} cannot be compared: {}", pathA.string(), pathB.string(), e.what()));
  }
}

void requireFields(const RunDifference& difference, std::span<const ComparedField> fields) {
  for (const ComparedField field : fields)
    for (const FrameDifference& frame : difference.frames)
      if (!frame[field])
        throw InputError(
            fmt::format("'{0}' cannot be compared, frame {1} or {2} (t = {3:g} s) does not hold it; "
                        "expected '{0}' in output.fields of both runs",
                        nameOf(field), frame.frameA, frame.frameB, frame.time));
}

}  // namespace

HistoryDifference compareHistories(std::span<const HistoryRow> a, std::span<const HistoryRow> b) {
  const TimeMatch match = matchTimes(rowTimes(a), rowTimes(b));
  HistoryDifference d;
  d.rows = match.pairs.size();
  if (d.rows == 0) return d;
  for (std::size_t k = 0; k < d.rows; ++k) {
    const int x = a[match.pairs[k].first].iterations, y = b[match.pairs[k].second].iterations;
    d.meanIterationsA += x, d.meanIterationsB += y;
    if (k < earlyRows) d.earlyIterations = std::max(d.earlyIterations, std::abs(x - y));
  }
  d.meanIterationsA /= static_cast<double>(d.rows), d.meanIterationsB /= static_cast<double>(d.rows);
  const HistoryRow &last = a[match.pairs.back().first], &expected = b[match.pairs.back().second];
  d.time = expected.time;
  d.frontX = relativeTo(expected.frontX, last.frontX - expected.frontX);
  d.top = relativeTo(expected.top, last.top - expected.top);
  d.kineticEnergy = relativeTo(expected.kineticEnergy, last.kineticEnergy - expected.kineticEnergy);
  return d;
}

RunDifference compareRuns(const RunDirectory& a, const RunDirectory& b) {
  const Case reference = readCase(b.caseFile(), {}, ShapeFiles::Leave);
  const TimeMatch match = matchTimes(frameTimes(a), frameTimes(b));
  if (match.pairs.empty())
    throw InputError(fmt::format("{} and {}: no frames have the same time", a.path().string(), b.path().string()));
  RunDifference d;
  for (const auto& [frameA, frameB] : match.pairs)
    d.frames.push_back(compareFrameFiles(a, b, frameA, frameB, reference));
  for (const std::size_t frame : match.onlyA) d.onlyInA.push_back(a.frameTime(frame));
  for (const std::size_t frame : match.onlyB) d.onlyInB.push_back(b.frameTime(frame));
  d.history = compareHistories(readHistory(a.history()), readHistory(b.history()));
  return d;
}

std::optional<Excess> firstExcess(const RunDifference& difference, std::span<const ComparedField> fields,
                                  double bound) {
  requireFields(difference, fields);
  std::optional<Excess> excess;
  for (std::size_t k = 0; k < difference.frames.size() && !excess; ++k) {
    double largest = bound;
    for (const ComparedField field : fields) {
      const double relative = difference.frames[k][field]->relative;
      if (relative <= largest || std::isnan(largest)) continue;
      largest = relative;
      excess = Excess{k, field};
    }
  }
  return excess;
}

void writeFrameDifferences(const std::filesystem::path& path, std::span<const FrameDifference> frames) {
  std::string text = "time,frame_a,frame_b";
  for (const auto& field : namesOf<ComparedField>)
    text += fmt::format(",{0}_max,{0}_rms,{0}_relative", field.name);
  text += '\n';
  for (const FrameDifference& frame : frames) {
    text += fmt::format("{},{},{}", frame.time, frame.frameA, frame.frameB);
    for (const auto& d : frame.fields)
      text += d ? fmt::format(",{},{},{}", d->maximum, d->rms, d->relative) : std::string(",,,");
    text += '\n';
  }
  writeFile(path, text);
}

}  // namespace treacle
