#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace treacle {

/// Writes all bytes, whatever pieces the system takes them in. False: errno says why.
bool writeAll(int descriptor, const char* data, std::size_t bytes);

/// "cannot write PATH: REASON" for a value of errno.
std::string writeFailure(const std::filesystem::path& path, int error);

}  // namespace treacle
