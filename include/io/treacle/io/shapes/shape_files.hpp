#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/mesh.hpp"

#include <filesystem>

namespace treacle {

/// Reads triangles from a file: .stl (binary or ASCII), .obj or .ply (ASCII or binary). Faces of more than three
/// corners become fans of triangles. Errors: InputError that begins with "path:line: ", or "path: " and the number
/// of the face in a binary file, for a file that is missing, empty, truncated, of another format, or whose numbers
/// are not finite or none of a vertex.
Triangles readTriangles(const std::filesystem::path& path);

/// Reads the files of all shapes that are not read yet: meshes, and particles (.vtp, .pvtp, .csv). Bodies that
/// name the same file share it. A file that is not where the case says is looked for in `folder`, that of the
/// case. Checksums that are not known are then set. Errors: CaseError for a file that is missing, is none of
/// these, or does not have the checksum that the case expects.
void readShapeFiles(Case& c, const std::filesystem::path& folder = {});

}  // namespace treacle
