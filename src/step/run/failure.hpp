#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/error.hpp"
#include "treacle/linear/krylov_scalars.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace treacle {

/// Why one way of solving was given up, e.g. "cr, bucket-multigrid, double: breakdown after 3 iterations, ...".
std::string describeStage(const SolverSettings& stage, const SolveReport& report);

/// The diagnosis of a solve that did not converge; `failures`: of the stages before the last one.
std::string describeFailure(const SolveReport& report, double tolerance, const std::string& failures);

/// The same of a solve for temperatures.
std::string describeHeatFailure(const SolveReport& report, const HeatSettings& settings);
/// Of one that follows the freezing, where so much is left, as |r|^2/|b|^2, after so many linear systems.
std::string describeFreezingFailure(double left, int systems, const HeatSettings& settings);

/// The diagnosis of viscosities that are not finite, of so many particles, of states, and of elastic stresses.
std::string describeViscosities(double particles);
std::string describeStates(double particles);
std::string describeElasticity(double particles);
/// Of volume factors out of bounds.
std::string describeVolumes(double particles);

/// Where the right-hand side b (per own fluid particle) is not finite, at some process.
template <int D>
std::string describeNotFinite(const Processes& processes, const Particles<D>& particles,
                              std::span<const Vec<D>> b);

/// Particle i has left the domain in a step of dt [s] at velocity u [m/s].
template <int D>
std::string describeLeaving(const Case& c, const Particles<D>& particles, std::uint32_t i, const Vec<D>& u,
                            double dt);

}  // namespace treacle
