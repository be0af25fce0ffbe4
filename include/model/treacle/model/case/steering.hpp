#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/body.hpp"

#include <optional>

namespace treacle {

/// How a wall or an inflow is to go on from some time; what is not given stays as the case has it.
struct Steering {
  std::optional<Vec<3>> velocity{};  // of a wall, or its centre if it rotates, or of a nozzle [m/s]
  std::optional<double> spin{};      // of one that has a rotation, about its axis [rad/s]
  std::optional<double> speed{};     // of the fluid relative to the nozzle that it comes out of [m/s]
  std::optional<double> flowRate{};  // or that through all of it [m3/s; m2/s in 2D]
};

/// The body that has moved as this one until time t [s], and goes on with these velocities. Its motion becomes
/// tables, which keep what was before: from the start it goes the same way. Errors: InputError for a body that
/// does not have what is steered or moves by an oscillation or a formula, and for numbers that cannot be.
Body steered(const Body& body, const Steering& steering, double t);

/// Whether steering the one into the other changes no more than numbers of a motion that is a function of time
/// already.
bool isSteeredAlready(const Body& body, const Body& next);

}  // namespace treacle
