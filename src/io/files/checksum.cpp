#include "checksum.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

namespace treacle {

void Checksum::add(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    std::uint64_t word = 0;
    const std::size_t size = std::min(bytes, sizeof word);
    std::memcpy(&word, next, size);
    value_ = (value_ ^ word ^ size) * 0x9E3779B97F4A7C15u;  // an odd factor has an inverse
    value_ ^= value_ >> 32;
    next += size, bytes -= size;
  }
}

ChecksumRecord ChecksumRecord::of(const void* content, std::size_t bytes) {
  Checksum checksum;
  checksum.add(content, bytes);
  ChecksumRecord record{{}, checksum.value()};
  std::copy(mark.begin(), mark.end(), record.name.begin());
  return record;
}

std::optional<bool> checksumHolds(const std::filesystem::path& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  ChecksumRecord record{};
  if (error || size < sizeof record) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(size - sizeof record));
  file.read(reinterpret_cast<char*>(&record), sizeof record);
  if (!file || !std::equal(record.name.begin(), record.name.end(), record.mark.begin())) return std::nullopt;
  file.seekg(0);
  Checksum checksum;
  std::vector<char> piece(1 << 20);
  for (std::uint64_t left = size - sizeof record; left > 0;) {
    const std::size_t bytes = std::min<std::uint64_t>(left, piece.size());
    if (!file.read(piece.data(), static_cast<std::streamsize>(bytes))) return std::nullopt;
    checksum.add(piece.data(), bytes);
    left -= bytes;
  }
  return checksum.value() == record.value;
}

}  // namespace treacle
