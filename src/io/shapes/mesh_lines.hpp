#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/geometry/mesh.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// The lines of a mesh as a text, by their words, which blanks part; empty ones are passed over.
class MeshLines {
 public:
  MeshLines(std::string path, std::string_view text) : path_(std::move(path)), rest_(text) {}

  /// Whether there is a next one, which then is this one.
  bool next();
  const std::vector<std::string_view>& words() const { return words_; }
  /// The first word of this line.
  std::string_view key() const { return words_.front(); }
  std::string_view rest() const { return rest_; }  // behind this line
  std::size_t line() const { return line_; }

  /// Errors: InputError, always: "path:line: what".
  [[noreturn]] void fail(const std::string& what) const;

  /// Errors: InputError where the word is missing, or no finite number.
  double number(std::size_t word) const;
  Vec<3> point(std::size_t first) const { return {number(first), number(first + 1), number(first + 2)}; }
  std::int64_t integer(std::string_view text) const;

 private:
  std::string path_;
  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
};

/// Coordinates are at most that [unit], so that volumes are finite.
inline constexpr double farthestVertex = 1e40;
/// Meshes are smaller: indices of their edges have 32 bits.
inline constexpr std::size_t maxTriangles = std::size_t{1} << 30;

/// Appends a face of a file by a fan of triangles; `face`: its number, from 1.
void appendFan(Triangles& triangles, const std::vector<std::uint32_t>& corners, std::size_t face);

}  // namespace treacle
