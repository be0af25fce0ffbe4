#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace treacle {

/// Checksum of bytes that come in pieces. One changed word always gives another one: each step can be undone.
class Checksum {
 public:
  /// Whole words of 8 bytes in all calls but the last.
  void add(const void* data, std::size_t bytes);
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

/// What stands behind the content of a file that has a checksum. Programs that know where the content ends do not
/// mind.
struct ChecksumRecord {
  static constexpr std::string_view mark = "treacle checksum";

  std::array<char, mark.size()> name;
  std::uint64_t value;

  static ChecksumRecord of(const void* content, std::size_t bytes);
};

/// Whether a file is the one that its record was made of; nothing where it has none or cannot be read.
std::optional<bool> checksumHolds(const std::filesystem::path& path);

}  // namespace treacle
