#pragma once

#include "treacle/core/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// What the files of the program of the authors of [K23] hold (docs/import.md). SI units throughout.

/// Types of particles: 0 and 1 are fluids, 2 and 3 walls.
inline constexpr int mphTypes = 4;
inline constexpr int firstMphWall = 2;

struct MphType {
  double density = 0, bulkModulus = 0, bulkViscosity = 0, shearViscosity = 0, surfaceTension = 0;
  std::array<double, mphTypes> interactionRatio{1, 1, 1, 1};
};

struct MphWall {
  Vec<3> center{}, velocity{}, omega{};
};

/// The parameters (.data).
struct MphParameters {
  std::string path;
  double step = 0, end = 0;                         // [s]
  double profileInterval = 0, pictureInterval = 0;  // OutputInterval, VtkOutputInterval [s]; 0: none
  double pressureRatio = 0, viscosityRatio = 0;     // radii over the particle distance
  Vec<3> gravity{};
  std::array<MphType, mphTypes> types;
  std::array<MphWall, mphTypes - firstMphWall> walls;  // of types 2 and 3
  std::map<std::string, std::size_t> lines;            // where the rows stand
  std::vector<std::string> warnings;                   // rows that are not known
};

struct MphParticle {
  int type = 0;
  Vec<3> position{}, velocity{};
};

struct MphCuboid {
  int type = 0;
  Vec<3> lower{}, upper{}, velocity{};
  std::size_t line = 0;  // where it starts
};

/// Particles (.grid) or the cuboids that they are made of (.boid): one of the two lists is empty.
struct MphGeometry {
  std::string path;
  double time = 0;     // of the particles [s]
  double spacing = 0;  // [m]
  Vec<3> lower{}, upper{};
  std::vector<MphCuboid> cuboids;
  std::vector<MphParticle> particles;
};

/// Read the content of a file; `path` is for messages. Errors: InputError that begins with path:line and says what
/// was found and expected.
MphParameters readMphParameters(const std::string& path, std::string_view content);
MphGeometry readMphParticles(const std::string& path, std::string_view content);
MphGeometry readMphCuboids(const std::string& path, std::string_view content);

}  // namespace treacle
