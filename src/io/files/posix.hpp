#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace treacle {

/// Writes all bytes, whatever pieces the system takes them in. False: errno says why.
bool writeAll(int descriptor, const char* data, std::size_t bytes);

/// The same from a place in a file on [B].
bool writeAllAt(int descriptor, std::uint64_t place, const char* data, std::size_t bytes);

/// What a file, a pipe or a device holds, or its first `most` + 1 bytes where that is more; nothing where it
/// cannot be read. A pipe that nobody writes to is empty.
std::optional<std::string> readAll(const std::filesystem::path& path, std::size_t most);

/// "cannot write PATH: REASON" for a value of errno.
std::string writeFailure(const std::filesystem::path& path, int error);

}  // namespace treacle
