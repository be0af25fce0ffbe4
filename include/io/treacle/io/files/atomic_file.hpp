#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace treacle {

/// A file that appears under its name only once it is complete: written to `<path>.tmp`, synchronised to disk
/// and renamed. Until commit() an older file of that name stays as it is. A symbolic link stays one: the file that
/// it leads to is replaced. What is no file but a device or a pipe is written to as it is.
/// Errors, of every member: RunError with path and reason; the temporary file is then removed.
/// A process that limits its file sizes has to ignore SIGXFSZ, otherwise the system ends it before the error
/// shows.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without commit() the content is thrown away.
  ~AtomicFile();

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// In place of what has been written there, none of which may be beyond the end. Not for devices and pipes.
  void overwrite(std::uint64_t place, const void* data, std::size_t bytes);
  void overwrite(std::uint64_t place, std::string_view text) { overwrite(place, text.data(), text.size()); }
  /// What has been written up to now [B].
  std::uint64_t size() const { return size_; }
  void commit();

  static std::filesystem::path temporaryName(std::filesystem::path path) { return path += ".tmp"; }

 private:
  void flush();
  [[noreturn]] void fail();
  void discard();
  void removeTemporary();

  std::filesystem::path path_, target_, temporary_;  // what the user calls it, and the file itself
  bool isFile_ = true;
  std::vector<char> pending_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

/// AtomicFile in one go.
void writeFile(const std::filesystem::path& path, std::string_view content);

}  // namespace treacle
