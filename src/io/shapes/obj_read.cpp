#include "mesh_format.hpp"
#include "mesh_lines.hpp"

#include <fmt/format.h>

namespace treacle {

Triangles readObj(const std::string& path, std::string_view content) {
  MeshLines lines(path, content);
  Triangles t;
  std::vector<std::uint32_t> corners;
  std::size_t faces = 0;
  while (lines.next()) {
    if (lines.key() == "v") {
      if (t.vertices.size() >= 3 * maxTriangles) lines.fail("more vertices than a mesh can have");
      t.vertices.push_back(lines.point(1));
    }
    if (lines.key() != "f") continue;  // normals, textures, groups and so on
    corners.clear();
    for (std::size_t k = 1; k < lines.words().size(); ++k) {
      const std::string_view word = lines.words()[k];
      const std::int64_t given = lines.integer(word.substr(0, word.find('/')));
      const auto count = static_cast<std::int64_t>(t.vertices.size());
      const std::int64_t index = given < 0 ? count + given : given - 1;  // from the last one back, or from 1
      if (given == 0 || index < 0 || index >= count)
        lines.fail(
            fmt::format("expected the number of one of the {} vertices before this face, found {}", count, given));
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    if (corners.size() < 3) lines.fail(fmt::format("expected 3 corners or more, found {}", corners.size()));
    if (t.corners.size() + corners.size() > maxTriangles) lines.fail("more faces than a mesh can have");
    appendFan(t, corners, ++faces);
  }
  if (t.corners.empty())
    lines.fail(
        fmt::format("no faces: expected lines of an OBJ, 'v x y z' and 'f a b c', found {} vertices and no face",
                    t.vertices.size()));
  return t;
}

}  // namespace treacle
