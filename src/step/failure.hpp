#pragma once

#include "treacle/core/error.hpp"
#include "treacle/linear/krylov_scalars.hpp"
#include "treacle/model/particles.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace treacle {

/// The diagnosis of a solve that did not converge.
std::string describeFailure(const SolveReport& report, double tolerance);

/// Where the right-hand side b (per fluid particle) is not finite.
template <int D>
std::string describeNotFinite(const Particles<D>& particles, std::span<const Vec<D>> b);

/// Particle i has left the domain in a step of dt [s] at velocity u [m/s].
template <int D>
std::string describeLeaving(const Particles<D>& particles, std::uint32_t i, const Vec<D>& u, double dt);

}  // namespace treacle
