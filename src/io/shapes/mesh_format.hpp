#pragma once

#include "treacle/model/geometry/mesh.hpp"

#include <string>
#include <string_view>

namespace treacle {

/// Triangles of the content of a file; `path` is for messages. Errors: those of readTriangles.
Triangles readStl(const std::string& path, std::string_view content);
Triangles readObj(const std::string& path, std::string_view content);
Triangles readPly(const std::string& path, std::string_view content);

}  // namespace treacle
