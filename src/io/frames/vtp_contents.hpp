#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// What a file of writeVtp says of itself before its values.
struct VtpContents {
  std::uint64_t particles = 0;
  double time = 0;  // [s]
  int dimensions = 3;
  struct Array {
    std::string type, name;
    int components = 1;

    bool operator==(const Array&) const = default;
  };
  std::vector<Array> pointData;
  std::string positionType;
};

/// Errors: those of readVtp but for the values.
VtpContents readVtpContents(const std::filesystem::path& path);

}  // namespace treacle
