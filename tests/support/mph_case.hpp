#pragma once

#include "treacle/core/vec.hpp"

#include <fmt/format.h>

#include <string>

namespace treacle::test {

/// A small dam break in the formats of the authors' program (docs/import.md), in two dimensions: 4 x 6 particles
/// beside a wall of type 2 and on a floor of type 3.
inline const std::string mphParameters = R"(# syrup
Dt                       1e-3
OutputInterval           5e-3
VtkOutputInterval        2e-3
EndTime                  4e-3
RadiusRatioA             3.5
RadiusRatioP             1.8
RadiusRatioV             3.4
Density                  1100   1000   900    800
BulkModulus              1e6    2e6    3e6    4e6
BulkViscosity            1e4    2e4    3e4    4e4
ShearViscosity           10     20     30     40
SurfaceTension           0      0      0      0
InteractionRatio(Type0)  1      1      1      1
Gravity                  0 -10 0
Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0
Wall3  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0
)";

inline const std::string mphCuboids = R"(# dam
ParticleDistance  1e-3
LowerDomain       -4e-3 -4e-3 -2e-3
UpperDomain       14e-3 14e-3  2e-3
StartCuboid
  Spacing   1e-3
  Type      1
  Lower     0 0 -0.5e-3
  Upper     4e-3 6e-3 0.5e-3
  Velocity  0.25 -0.5 0
EndCuboid
StartCuboid
  Spacing   1e-3
  Type      2
  Lower     -4e-3 -4e-3 -0.5e-3
  Upper     0 8e-3 0.5e-3
  Velocity  0 0 0
EndCuboid
StartCuboid
  Spacing   1e-3
  Type      3
  Lower     0 -4e-3 -0.5e-3
  Upper     14e-3 0 0.5e-3
  Velocity  0 0 0
EndCuboid
)";

/// Rows of particles whose cells fill a cuboid of nx x ny x nz from (x, y, z), all in spacings of 1 mm, x first.
inline std::string mphRows(int type, Vec<3> corner, int nx, int ny, int nz, const std::string& velocity) {
  std::string rows;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        rows += fmt::format("{} {:e} {:e} {:e} {}\n", type, 1e-3 * (corner[0] + i + 0.5),
                            1e-3 * (corner[1] + j + 0.5), 1e-3 * (corner[2] + k + 0.5), velocity);
  return rows;
}

/// The same case as particles.
inline const std::string mphParticles =
    "0.0\n128 1e-3  -4e-3 14e-3  -4e-3 14e-3  -2e-3 2e-3\n" + mphRows(1, {0, 0, -0.5}, 4, 6, 1, "0.25 -0.5 0") +
    mphRows(2, {-4, -4, -0.5}, 4, 12, 1, "0 0 0") + mphRows(3, {0, -4, -0.5}, 14, 4, 1, "0 0 0");

}  // namespace treacle::test
