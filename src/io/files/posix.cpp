#include "posix.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace treacle {

namespace {

/// writeSome(data, bytes): as ::write.
template <class F>
bool writeInPieces(const char* data, std::size_t bytes, F writeSome) {
  while (bytes > 0) {
    const ssize_t written = writeSome(data, bytes);
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

bool writeAll(int descriptor, const char* data, std::size_t bytes) {
  return writeInPieces(data, bytes,
                       [&](const char* from, std::size_t size) { return ::write(descriptor, from, size); });
}

bool writeAllAt(int descriptor, std::uint64_t place, const char* data, std::size_t bytes) {
  return writeInPieces(data, bytes, [&](const char* from, std::size_t size) {
    return ::pwrite(descriptor, from, size, static_cast<off_t>(place) + (from - data));
  });
}

std::optional<std::string> readAll(const std::filesystem::path& path, std::size_t most) {
  // Who opens a pipe otherwise waits until somebody writes to it.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  std::string text;
  constexpr std::size_t piece = 1 << 16;
  ssize_t got = 1;
  while (got > 0 && text.size() <= most) {
    const std::size_t before = text.size();
    text.resize(before + piece);
    do got = ::read(descriptor, text.data() + before, piece);
    while (got < 0 && errno == EINTR);
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  ::close(descriptor);
  return got < 0 ? std::nullopt : std::optional(std::move(text));
}

std::string writeFailure(const std::filesystem::path& path, int error) {
  return fmt::format("cannot write {}: {}", path.string(), std::generic_category().message(error));
}

}  // namespace treacle
