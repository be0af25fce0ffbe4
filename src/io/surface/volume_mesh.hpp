#pragma once

#include "treacle/core/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace treacle {

/// A field on a grid of which some blocks of 8 x 8 x 8 nodes are known: elsewhere it has one of two values.
struct BlockedField {
  std::vector<std::array<int, 3>> blocks,
      inside;  // which are to be asked for, and where it is `within` throughout
  float outside = 0, within = 0;
  /// Sets the values of blocks[k], the last axis running fastest. Several threads call it at once. Returns false
  /// if all are `outside`.
  std::function<bool(std::size_t k, float* values)> values;
};

struct TriangleMesh {
  std::vector<Vec<3, float>> points;                    // in nodes from that of block (0, 0, 0)
  std::vector<std::array<std::uint32_t, 3>> triangles;  // anticlockwise as seen from where the field is positive
};

/// Why volumeMesh() cannot be called; empty where it can. Loads the module that calls OpenVDB.
std::string whyNoVolumeMesh();

/// Where the field is zero, by dual contouring. Errors: std::bad_alloc; InputError where whyNoVolumeMesh() says
/// so.
TriangleMesh volumeMesh(const BlockedField& field);

/// The one function of the module.
using VolumeMeshFunction = void(const BlockedField& field, TriangleMesh& mesh);
inline constexpr const char* volumeMeshFunction = "treacleVolumeMesh";

}  // namespace treacle
