#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Mean velocity of a wall in the step of dt from time t on [m/s]: the walls are where their motion puts them at
/// the end of each step.
Vec<3> wallVelocity(const Body& body, double t, double dt);
/// Its acceleration at time t [m/s2].
Vec<3> wallAcceleration(const Body& body, double t);

/// velocity[k] = bodyVelocity[body[k]] per wall particle; all in the backend's memory. Errors: none, body < size
/// of bodyVelocity.
template <int D>
void setWallVelocities(Context<Cpu>&, std::span<const std::uint8_t> body, std::span<const Vec<D>> bodyVelocity,
                       std::span<Vec<D>> velocity);
template <int D>
void setWallVelocities(Context<Cuda>&, std::span<const std::uint8_t> body, std::span<const Vec<D>> bodyVelocity,
                       std::span<Vec<D>> velocity);

}  // namespace treacle
