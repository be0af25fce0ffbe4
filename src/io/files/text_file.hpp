#pragma once

#include <filesystem>
#include <string>

namespace treacle {

/// The whole content of a file. Errors: InputError with path and reason.
std::string readTextFile(const std::filesystem::path& path);

}  // namespace treacle
