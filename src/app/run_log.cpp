#include "run_log.hpp"

#include "print.hpp"
#include "treacle/core/error.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace treacle {
namespace {

/// The time of day where the machine is: "2024-01-31 23:59:59.999".
std::string timeStamp() {
  using namespace std::chrono;
  const auto now = floor<milliseconds>(system_clock::now());
  const std::time_t whole = system_clock::to_time_t(now);  // [s]
  std::tm local{};
  localtime_r(&whole, &local);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03}", local, now.time_since_epoch().count() % 1000);
}

}  // namespace

void printWarning(const std::string& text) { printError(fmt::format("treacle: warning: {}\n", text)); }

RunLog::RunLog(const std::filesystem::path& path, bool quiet) : file_(path), quiet_(quiet) {
  if (!file_) throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
}

void RunLog::info(const std::string& text) { write("info", text); }

void RunLog::warning(const std::string& text) {
  write("warning", text);
  if (!quiet_) printWarning(text);
}

void RunLog::error(const std::string& text) { write("error", text); }

void RunLog::write(std::string_view level, const std::string& text) {
  const std::lock_guard lock(mutex_);
  file_.clear();  // where a line is lost the next one may have room again
  file_ << fmt::format("{} {}: {}\n", timeStamp(), level, text) << std::flush;
}

}  // namespace treacle
