#include "progress.hpp"
#include "print.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace treacle {
namespace {

using namespace std::chrono_literals;

constexpr auto terminalPause = 100ms;
constexpr auto plainPause = 60s;

int tenthsOf(double done) { return static_cast<int>(10 * done * (1 + 1e-9)); }

}  // namespace

Progress::Progress(const Case& c, std::int64_t step, double time, bool quiet)
    : case_(c),
      first_(done(step, time)),
      quiet_(quiet),
      terminal_(::isatty(STDOUT_FILENO) == 1),
      tenths_(tenthsOf(first_)),
      start_(Clock::now()),
      last_(start_) {}

void Progress::update(const StepReport& report) {
  if (quiet_) return;
  const auto now = Clock::now();
  const bool finished = case_.atEnd(report.step, report.time);
  if (terminal_) {
    if (!finished && now - last_ < terminalPause) return;
    print("\r{}\033[K", line(report));
    lineOpen_ = !finished;
    if (finished) print("\n");
  } else {
    const int tenths = tenthsOf(done(report.step, report.time));
    if (tenths == tenths_ && now - last_ < plainPause) return;
    tenths_ = tenths;
    print("{}\n", line(report));
  }
  last_ = now;
  flushPrinted();
}

void Progress::message(const std::string& text) {
  if (quiet_) return;
  endLine();
  print("{}\n", text);
  flushPrinted();
}

void Progress::endLine() {
  if (lineOpen_) print("\n");
  lineOpen_ = false;
  flushPrinted();
}

std::string Progress::line(const StepReport& report) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double now = done(report.step, report.time);
  const std::string left = durationText(elapsed / (now - first_) * (1 - now));
  if (case_.time.stepsVary())
    return fmt::format("step {}  t = {:.4g} s ({:.0f} %)  {} iterations  {} left", report.step, report.time,
                       100 * now, report.iterations, left);
  return fmt::format("step {}/{}  t = {:.4g} s  {} iterations  {} left", report.step, case_.steps(), report.time,
                     report.iterations, left);
}

double Progress::done(std::int64_t step, double time) const {
  return case_.time.stepsVary() ? std::min(1.0, time / case_.time.end)
                                : static_cast<double>(step) / static_cast<double>(case_.steps());
}

std::string durationText(double seconds) {
  if (seconds < 60) return fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0);
  const auto whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace treacle
