#include "run_log.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>

namespace treacle {

void printWarning(const std::string& text) { fmt::print(stderr, "treacle: warning: {}\n", text); }

RunLog::RunLog(const std::filesystem::path& path, bool quiet) : quiet_(quiet) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string(), true);
    logger_ = std::make_shared<spdlog::logger>("run", std::move(sink));
  } catch (const spdlog::spdlog_ex& e) {
    throw RunError(fmt::format("{}: {}", path.string(), e.what()));
  }
  logger_->set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
  logger_->flush_on(spdlog::level::info);
  logger_->set_error_handler([](const std::string&) {});
}

RunLog::~RunLog() = default;

void RunLog::info(const std::string& text) { logger_->info("{}", text); }

void RunLog::warning(const std::string& text) {
  logger_->warn("{}", text);
  if (!quiet_) printWarning(text);
}

void RunLog::error(const std::string& text) { logger_->error("{}", text); }

}  // namespace treacle
