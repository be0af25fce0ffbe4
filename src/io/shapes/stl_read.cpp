#include "mesh_format.hpp"
#include "mesh_lines.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace treacle {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it is in memory");

constexpr std::size_t headerBytes = 80, facetBytes = 50;

std::uint32_t facetCount(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + headerBytes, sizeof count);
  return count;
}

std::size_t binaryBytes(std::uint64_t facets) { return headerBytes + sizeof(std::uint32_t) + facets * facetBytes; }

void append(Triangles& t, const Vec<3>* corner) {
  const auto first = static_cast<std::uint32_t>(t.vertices.size());
  t.vertices.insert(t.vertices.end(), corner, corner + 3);
  t.corners.push_back({first, first + 1, first + 2});
}

Triangles readBinary(const std::string& path, std::string_view content) {
  const std::uint32_t count = facetCount(content);
  const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", path, what)); };
  if (count == 0) fail("no faces: the header of this binary STL says 0");
  if (content.size() >= binaryBytes(std::uint64_t{count} + 1))
    fail(fmt::format("its header says {} faces, but the file has room for {}: as a binary STL it is damaged",
                     count, (content.size() - binaryBytes(0)) / facetBytes));
  if (content.size() < binaryBytes(count))
    fail(
        fmt::format("truncated, or no STL: as a binary one its header promises {} faces in {} bytes, the file has "
                    "{}; as an ASCII one it would begin with 'solid'",
                    count, binaryBytes(count), content.size()));
  if (count > maxTriangles)
    fail(fmt::format("{} faces are more than the {} that a mesh can have", count, maxTriangles));
  Triangles t;
  t.vertices.reserve(std::size_t{3} * count), t.corners.reserve(count);
  const char* facet = content.data() + binaryBytes(0);
  for (std::uint32_t k = 0; k < count; ++k, facet += facetBytes) {
    float values[12];  // the normal, which follows from the corners, and these
    std::memcpy(values, facet, sizeof values);
    Vec<3> corner[3];
    for (int i = 0; i < 9; ++i) {
      if (!std::isfinite(values[3 + i]))
        fail(fmt::format("face {}: expected finite coordinates, found {}", k + 1, values[3 + i]));
      corner[i / 3][i % 3] = values[3 + i];
    }
    append(t, corner);
  }
  return t;
}

std::string inSmallLetters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return small;
}

class AsciiStl {
 public:
  AsciiStl(const std::string& path, std::string_view content) : lines_(path, content) {}

  Triangles triangles() {
    Triangles t;
    expect("solid");
    bool open = true;
    while (lines_.next()) {
      if (isKey("endsolid") || isKey("solid")) {
        if (open == isKey("solid")) wrong("facet' or 'endsolid");
        open = !open;
        continue;
      }
      if (!isKey("facet")) wrong(open ? "facet' or 'endsolid" : "solid");
      readFacet(t);
    }
    if (open) lines_.fail("truncated: expected 'facet' or 'endsolid', found the end of the file");
    if (t.corners.empty()) lines_.fail("no faces in this STL");
    return t;
  }

 private:
  void readFacet(Triangles& t) {
    if (t.corners.size() >= maxTriangles) lines_.fail("more faces than a mesh can have");
    expect("outer");
    Vec<3> corner[3];
    for (Vec<3>& x : corner) {
      expect("vertex");
      x = lines_.point(1);
    }
    expect("endloop"), expect("endfacet");
    append(t, corner);
  }

  void expect(std::string_view key) {
    if (!lines_.next()) lines_.fail(fmt::format("truncated: expected '{}', found the end of the file", key));
    if (!isKey(key)) wrong(key);
  }
  bool isKey(std::string_view key) const { return inSmallLetters(lines_.key().substr(0, key.size() + 1)) == key; }
  [[noreturn]] void wrong(std::string_view expected) const {
    lines_.fail(fmt::format("expected '{}' of an ASCII STL, found '{}'", expected, lines_.key()));
  }

  MeshLines lines_;
};

}  // namespace

/// Binary ones may begin with 'solid', too: bytes that no text has tell, and the size, which some programs fill
/// up.
Triangles readStl(const std::string& path, std::string_view content) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  const bool longEnough = content.size() >= binaryBytes(0);
  if (longEnough && content.size() >= binaryBytes(facetCount(content)) &&
      content.size() < binaryBytes(std::uint64_t{facetCount(content)} + 1))
    return readBinary(path, content);
  const std::string_view text = content.starts_with(mark) ? content.substr(mark.size()) : content;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool isText =
      first != text.npos && inSmallLetters(text.substr(first, 5)) == "solid" && text.find('\0') == text.npos;
  if (isText || !longEnough) return AsciiStl(path, text).triangles();
  return readBinary(path, content);
}

}  // namespace treacle
