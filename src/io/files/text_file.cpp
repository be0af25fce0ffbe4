#include "text_file.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace treacle {

std::string readTextFile(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(fmt::format("{}: {}", path.string(), error.message()));
  std::string text(size, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(
        fmt::format("{}: UTF-16 text; expected UTF-8 (\"CSV UTF-8\" of a spreadsheet program)", path.string()));
  return text;
}

}  // namespace treacle
