#include "mesh_format.hpp"
#include "mesh_lines.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace treacle {
namespace {

enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

struct ScalarName {
  std::string_view name, other;
  Scalar type;
  std::size_t bytes;
};
constexpr ScalarName scalars[] = {
    {"char", "int8", Scalar::Int8, 1},      {"uchar", "uint8", Scalar::Uint8, 1},
    {"short", "int16", Scalar::Int16, 2},   {"ushort", "uint16", Scalar::Uint16, 2},
    {"int", "int32", Scalar::Int32, 4},     {"uint", "uint32", Scalar::Uint32, 4},
    {"float", "float32", Scalar::Float, 4}, {"double", "float64", Scalar::Double, 8}};

std::size_t bytesOf(Scalar type) { return scalars[static_cast<std::size_t>(type)].bytes; }

struct Property {
  std::string name;
  Scalar type;
  std::optional<Scalar> count;  // of a list
};
struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view content)
      : path_(path), size_(content.size()), lines_(path, content) {}

  Triangles triangles() {
    readHeader();
    for (const Element& element : elements_) {
      requireRoom(element);
      if (element.name == "vertex") t_.vertices.reserve(element.count);
      if (element.name == "face") t_.corners.reserve(element.count), t_.face.reserve(element.count);
      for (row_ = 0; row_ < element.count; ++row_) readRow(element);
    }
    if (t_.corners.empty()) fail("no faces in this PLY");
    return std::move(t_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", path_, what)); }
  /// With the line, or in a binary file the vertex or face.
  [[noreturn]] void failAt(const Element& element, const std::string& what) const {
    if (!binary_) lines_.fail(what);
    fail(fmt::format("{} {}: {}", element.name, row_ + 1, what));
  }

  void readHeader() {
    if (!lines_.next() || lines_.key() != "ply") lines_.fail("expected a PLY, which begins with 'ply'");
    bool known = false;
    while (lines_.next() && lines_.key() != "end_header") {
      const auto& words = lines_.words();
      if (words[0] == "format" && words.size() == 3)
        known = readFormat(words[1]);
      else if (words[0] == "element" && words.size() == 3)
        elements_.push_back({std::string(words[1]), readCount(words[2]), {}});
      else if (words[0] == "property" && !elements_.empty())
        elements_.back().properties.push_back(readProperty(words));
      else if (words[0] != "comment" && words[0] != "obj_info")
        lines_.fail(fmt::format("expected 'format', 'element', 'property' or 'end_header' of a PLY, found '{}'",
                                words[0]));
    }
    if (lines_.words().empty()) lines_.fail("truncated: expected 'end_header', found the end of the file");
    if (!known)
      lines_.fail("no format: expected 'format ascii 1.0', or 'binary_little_endian', 'binary_big_endian'");
    rest_ = lines_.rest();
  }

  bool readFormat(std::string_view word) {
    binary_ = word != "ascii", swapped_ = word == "binary_big_endian";
    if (binary_ && !swapped_ && word != "binary_little_endian")
      lines_.fail(
          fmt::format("expected 'ascii', 'binary_little_endian' or 'binary_big_endian', found '{}'", word));
    return true;
  }

  std::uint64_t readCount(std::string_view word) const {
    const std::int64_t count = lines_.integer(word);
    if (count < 0) lines_.fail(fmt::format("expected a number of elements, found {}", count));
    return static_cast<std::uint64_t>(count);
  }

  Scalar readType(std::string_view word) const {
    const auto found =
        std::ranges::find_if(scalars, [&](const ScalarName& s) { return s.name == word || s.other == word; });
    if (found == std::end(scalars)) lines_.fail(fmt::format("expected a type such as 'float', found '{}'", word));
    return found->type;
  }

  Property readProperty(const std::vector<std::string_view>& words) const {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) lines_.fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    if (list) return {std::string(words[4]), readType(words[3]), readType(words[2])};
    return {std::string(words[2]), readType(words[1]), std::nullopt};
  }

  /// Before memory is taken for what the header promises.
  void requireRoom(const Element& element) const {
    std::size_t bytes = 0;
    for (const Property& p : element.properties) bytes += binary_ ? bytesOf(p.count.value_or(p.type)) : 2;
    if (!binary_) bytes = std::max<std::size_t>(bytes, 1) - 1 + (bytes > 0);
    const std::size_t left = binary_ ? rest_.size() : lines_.rest().size() + 1;
    if (element.count > 3 * maxTriangles)
      fail(fmt::format("{} of '{}' are more than a mesh can have", element.count, element.name));
    if (bytes > 0 && element.count > left / bytes)
      fail(fmt::format("truncated: the header promises {} of '{}' in {} bytes or more, {} are left in the file",
                       element.count, element.name, element.count * bytes, left));
    if (element.properties.empty() && element.count > size_)
      fail(fmt::format("the header promises {} of '{}', which have no properties", element.count, element.name));
  }

  void readRow(const Element& element) {
    const bool vertex = element.name == "vertex", face = element.name == "face";
    if (!binary_) {
      if (element.properties.empty()) return;
      if (!lines_.next())
        lines_.fail(fmt::format("truncated: expected {} of '{}', found {}", element.count, element.name, row_));
      word_ = 0;
    }
    std::array<std::optional<double>, 3> x;
    bool corners = false;
    for (const Property& p : element.properties) {
      if (p.count) {
        readList(element, p);
        if (face && (p.name == "vertex_indices" || p.name == "vertex_index")) corners = true, takeFace(element);
        continue;
      }
      const double value = scalar(element, p.type);
      if (vertex && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
        x[static_cast<std::size_t>(p.name[0] - 'x')] = value;
    }
    if (face && !corners) fail("expected a list 'vertex_indices' among the properties of 'face', found none");
    if (vertex) takeVertex(element, x);
  }

  void takeVertex(const Element& element, const std::array<std::optional<double>, 3>& x) {
    if (!x[0] || !x[1] || !x[2]) fail("expected 'x', 'y' and 'z' among the properties of 'vertex'");
    for (const auto& value : x)
      if (!(std::abs(*value) <= farthestVertex))
        failAt(element,
               fmt::format("expected finite coordinates of at most {:g}, found {}", farthestVertex, *value));
    t_.vertices.push_back({*x[0], *x[1], *x[2]});
  }

  void takeFace(const Element& element) {
    corners_.clear();
    for (const double value : list_) {
      if (!(value >= 0 && value < static_cast<double>(t_.vertices.size())))
        failAt(element, fmt::format("expected indices from 0 to {}, found {}",
                                    static_cast<std::int64_t>(t_.vertices.size()) - 1, value));
      corners_.push_back(static_cast<std::uint32_t>(value));
    }
    if (corners_.size() < 3) failAt(element, fmt::format("expected 3 corners or more, found {}", corners_.size()));
    if (t_.corners.size() + corners_.size() > maxTriangles) fail("more faces than a mesh can have");
    appendFan(t_, corners_, row_ + 1);
  }

  void readList(const Element& element, const Property& p) {
    const double count = scalar(element, *p.count);
    if (!(count >= 0 &&
          count <= static_cast<double>(binary_ ? rest_.size() / bytesOf(p.type) : lines_.words().size())))
      failAt(element, fmt::format("truncated: a list of {} values, more than are left", count));
    list_.clear();
    for (double k = 0; k + 0.5 < count; ++k) list_.push_back(scalar(element, p.type));
  }

  double scalar(const Element& element, Scalar type) {
    if (!binary_) {
      if (word_ >= lines_.words().size()) lines_.fail("expected more values on this line");
      return lines_.number(word_++);
    }
    std::array<char, 8> bytes{};
    const std::size_t size = bytesOf(type);
    if (rest_.size() < size) failAt(element, "truncated: the file ends before its data does");
    for (std::size_t k = 0; k < size; ++k) bytes[k] = rest_[swapped_ ? size - 1 - k : k];
    rest_.remove_prefix(size);
    const auto as = [&]<class T>(T value) {
      std::memcpy(&value, bytes.data(), sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
      case Scalar::Int8:
        return as(std::int8_t{});
      case Scalar::Uint8:
        return as(std::uint8_t{});
      case Scalar::Int16:
        return as(std::int16_t{});
      case Scalar::Uint16:
        return as(std::uint16_t{});
      case Scalar::Int32:
        return as(std::int32_t{});
      case Scalar::Uint32:
        return as(std::uint32_t{});
      case Scalar::Float:
        return as(float{});
      case Scalar::Double:
        break;
    }
    return as(double{});
  }

  std::string path_;
  std::size_t size_;  // [B]
  MeshLines lines_;
  std::string_view rest_;  // of a binary file
  bool binary_ = false, swapped_ = false;
  std::vector<Element> elements_;
  std::uint64_t row_ = 0;  // of the element at hand
  std::size_t word_ = 0;   // of the line at hand
  std::vector<double> list_;
  std::vector<std::uint32_t> corners_;
  Triangles t_;
};

}  // namespace

Triangles readPly(const std::string& path, std::string_view content) {
  return PlyReader(path, content).triangles();
}

}  // namespace treacle
