#pragma once

#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

namespace treacle {

/// Prints "treacle: warning: ..." to stderr.
void printWarning(const std::string& text);

/// `run.log` of a run directory, one dated line per event. A disk that fills up does not stop the run here: the
/// lines are lost. May be used by several threads.
class RunLog {
 public:
  /// `quiet`: warnings go into the file only. Errors: RunError if the file cannot be opened.
  RunLog(const std::filesystem::path& path, bool quiet);

  void info(const std::string& text);
  void warning(const std::string& text);  // to stderr as well
  void error(const std::string& text);

 private:
  void write(std::string_view level, const std::string& text);

  std::ofstream file_;
  std::mutex mutex_;
  bool quiet_;
};

}  // namespace treacle
