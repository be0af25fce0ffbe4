#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace treacle {

/// A text file that grows by rows, each handed to the system at once: a run that is killed leaves whole rows.
/// Errors, of every member: RunError with path and reason; the file then ends with the last whole row.
class RowFile {
 public:
  /// Replaces an older file. Header and rows come without the ends of their lines.
  RowFile(std::filesystem::path path, const std::string& header);
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  void append(std::string row);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;  // [B] whole rows
};

}  // namespace treacle
