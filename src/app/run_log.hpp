#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace spdlog {
class logger;
}

namespace treacle {

/// Prints "treacle: warning: ..." to stderr.
void printWarning(const std::string& text);

/// `run.log` of a run directory, one dated line per event. A disk that fills up does not stop the run here: the
/// lines are lost. info() may be called by several threads.
class RunLog {
 public:
  /// `quiet`: warnings go into the file only. Errors: RunError if the file cannot be opened.
  RunLog(const std::filesystem::path& path, bool quiet);
  ~RunLog();

  void info(const std::string& text);
  void warning(const std::string& text);  // to stderr as well
  void error(const std::string& text);

 private:
  std::shared_ptr<spdlog::logger> logger_;
  bool quiet_;
};

}  // namespace treacle
