#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle {

/// The largest size of a function of time in a part of the run [s], among many times; of a table that of its rows.
double largestSize(const TimeFunction& f, double from, double to);

/// Shortest side of an opening, or distance between the radii of a ring [m].
double widthOf(const Nozzle& n, int dimensions);

/// What drives the fluid of a case beside gravity, inflows and what walls take along.
struct Drives {
  double pressure = 0;  // largest one of openings, and of given forces on bodies over their cross-sections [Pa]
  double seep = 0;      // speed to which that brings a fluid against its viscosity, times the latter [Pa m]
  double speed = 0;     // largest mean one of given flow rates through openings [m/s]
  double shear = 0;  // pressure that the fluid builds up, over its viscosity, where walls drag or openings press
                     // it through a narrow way [1/s]
};

/// `length`: shortest side of the fluid [m]. A fluid goes through a slit, or in three dimensions a tube, which is
/// as long as the fluid at the start and the openings are apart.
Drives drivesOf(const Case& c, double length);

}  // namespace treacle
