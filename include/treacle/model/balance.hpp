#pragma once

#include "treacle/core/vec.hpp"

#include <vector>

namespace treacle {

/// What the fluid exerts on a wall body by pressure, viscosity and repulsion; in 2D per metre of depth, the torque
/// along z.
struct WallLoad {
  Vec<3> force{};   // [N]
  Vec<3> torque{};  // about the wall's centre of rotation, else the origin [N m]
};

/// Where the energy of the fluid goes in one step of MPH-I, with the velocities at its end and the places at its
/// start; in 2D per metre of depth. Kinetic energy gains dt times the power of gravity, elastic pressures,
/// repulsion and walls less the two dissipations and the inertial loss.
struct Balance {
  double shearDissipation = 0;  // [W]
  double bulkDissipation = 0;   // [W]
  double inertialLoss = 0;      // sum of m |u^{k+1} - u^k|^2 / (2 dt): what the implicit step takes [W]
  double elasticPower = 0;      // what kappa [n - n_0]_+ gives to the motion [W]
  double elasticEnergy = 0;     // [J]
  double wallPower = 0;         // what walls that move give to the fluid [W]
  std::vector<WallLoad> walls;  // of the wall bodies, in the order of the case
  double repulsionPower = 0;    // what the repulsion of close particles gives to the motion [W]
};

}  // namespace treacle
