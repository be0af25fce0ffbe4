#pragma once

#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace treacle::fuzz {

/// A file in memory, for readers that take a path.
class InputFile {
 public:
  explicit InputFile(std::string_view content) : descriptor_(::memfd_create("input", MFD_CLOEXEC)) {
    append(content.data(), content.size());
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() { ::close(descriptor_); }

  void append(const void* data, std::size_t bytes) {
    if (::write(descriptor_, data, bytes) != static_cast<ssize_t>(bytes)) std::abort();
  }

  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// What a reader may do with a file: take it, or say what is wrong with it.
template <class F>
void accept(F&& read) {
  try {
    read();
  } catch (const InputError&) {
    // Said so.
  }
}

}  // namespace treacle::fuzz
