#include "posix.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace treacle {

bool writeAll(int descriptor, const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor, data, bytes);
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

std::string writeFailure(const std::filesystem::path& path, int error) {
  return fmt::format("cannot write {}: {}", path.string(), std::generic_category().message(error));
}

}  // namespace treacle
