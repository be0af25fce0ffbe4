#pragma once

#include "treacle/core/vec.hpp"

#include <memory>
#include <string>
#include <vector>

namespace treacle {

class Mesh;

/// What was read of a file. Comparisons pass over it: the file's checksum stands for it.
template <class T>
struct Content {
  std::shared_ptr<const T> value{};

  bool operator==(const Content&) const { return true; }
};

/// Particles of a file. Fields that it does not hold are empty.
struct GivenParticles {
  std::vector<Vec<3>> position;     // [m]
  std::vector<Vec<3>> velocity;     // [m/s]
  std::vector<double> temperature;  // [K]
};

/// A file that a shape is made of. A case that was read without its files, or is made in code, has no content.
struct ShapeFile {
  std::string path{};                   // absolute where it comes from a case file
  std::string checksum{};               // of its bytes, 16 hexadecimal digits; empty: not known
  Content<Mesh> mesh{};                 // in the coordinates of the file
  Content<GivenParticles> particles{};  // likewise

  bool operator==(const ShapeFile&) const = default;
};

}  // namespace treacle
