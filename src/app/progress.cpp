#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace treacle {
namespace {

using namespace std::chrono_literals;

constexpr auto terminalPause = 100ms;
constexpr auto plainPause = 60s;

}  // namespace

Progress::Progress(std::int64_t start, std::int64_t steps, bool quiet)
    : first_(start),
      steps_(steps),
      quiet_(quiet),
      terminal_(::isatty(STDOUT_FILENO) == 1),
      tenths_(10 * start / steps),
      start_(Clock::now()),
      last_(start_) {}

void Progress::update(const StepReport& report) {
  if (quiet_) return;
  const auto now = Clock::now();
  const bool finished = report.step >= steps_;
  if (terminal_) {
    if (!finished && now - last_ < terminalPause) return;
    fmt::print("\r{}\033[K", line(report));
    lineOpen_ = !finished;
    if (finished) fmt::print("\n");
  } else {
    const std::int64_t tenths = 10 * report.step / steps_;
    if (tenths == tenths_ && now - last_ < plainPause) return;
    tenths_ = tenths;
    fmt::print("{}\n", line(report));
  }
  last_ = now;
  std::fflush(stdout);
}

void Progress::message(const std::string& text) {
  if (quiet_) return;
  endLine();
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

void Progress::endLine() {
  if (lineOpen_) fmt::print("\n");
  lineOpen_ = false;
  std::fflush(stdout);
}

std::string Progress::line(const StepReport& report) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left =
      elapsed / static_cast<double>(report.step - first_) * static_cast<double>(steps_ - report.step);
  return fmt::format("step {}/{}  t = {:.4g} s  {} iterations  {} left", report.step, steps_, report.time,
                     report.iterations, durationText(left));
}

std::string durationText(double seconds) {
  if (seconds < 60) return fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0);
  const auto whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace treacle
