#pragma once

#include "treacle/core/vec.hpp"

#include <optional>
#include <vector>

namespace treacle {

/// What the fluid exerts on a wall body by pressure, viscosity and repulsion; in 2D per metre of depth, the torque
/// along z.
struct WallLoad {
  Vec<3> force{};    // [N]
  Vec<3> torque{};   // about the wall's centre of rotation, else the origin [N m]
  double power = 0;  // of the fluid on it [W]
};

/// The heat of the fluid in one step: the energy gains dt times the other four.
struct HeatBalance {
  double energy = 0;   // sum of the enthalpies, counted from 0 K, at the end of the step [J]
  double heating = 0;  // by the viscosity [W]
  double walls = 0;    // from walls [W]
  double states = 0;   // set free by the states of materials [W]
  double surface = 0;  // from the surroundings through free surfaces [W]
};

/// Where the energy of the fluid goes in one step of MPH-I, with the velocities at its end and the places at its
/// start; in 2D per metre of depth. Kinetic energy gains dt times the power of gravity, buoyancy, elastic
/// pressures, repulsion, surface tension, shift and walls less the two dissipations and the inertial loss.
struct Balance {
  double shearDissipation = 0;        // [W]
  double bulkDissipation = 0;         // [W]
  double inertialLoss = 0;            // sum of m |u^{k+1} - u^k|^2 / (2 dt): what the implicit step takes [W]
  double elasticPower = 0;            // what the elastic pressures give to the motion [W]
  double elasticEnergy = 0;           // [J]
  double wallPower = 0;               // what walls that move give to the fluid [W]
  std::vector<WallLoad> walls;        // of the wall bodies, in the order of the case
  double repulsionPower = 0;          // what the repulsion of close particles gives to the motion [W]
  double shiftPower = 0;              // what the shift of particles adds to their potential energy [W]
  double surfacePower = 0;            // what surface tension gives to the motion [W]
  double buoyancyPower = 0;           // what thermal expansion adds to the power of gravity [W]
  double surfaceEnergy = 0;           // of the free surfaces, gamma times their area [J]
  std::optional<HeatBalance> heat{};  // in cases with heat
  std::vector<double> patches{};      // pressures of the probes WallPressure, in the order of the case [Pa]
};

}  // namespace treacle
