#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/any_particles.hpp"
#include "treacle/step/simulation.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace treacle {

/// A simulation whose dimensions, backend and precision are chosen as it is made: by the case and its particles,
/// by the caller, and by the case's solver. Who runs cases goes through here; who looks into a step takes
/// Simulation. Members mean the same as those of Simulation.
class AnySimulation {
 public:
  /// Errors: CaseError for a case that cannot be run, InputError for particles of other dimensions or a backend
  /// that this build does not have, std::bad_alloc.
  AnySimulation(const Case& c, AnyParticles particles, BackendKind backend = BackendKind::Cpu,
                std::int64_t step = 0, double time = 0);
  ~AnySimulation();
  AnySimulation(AnySimulation&&) noexcept;

  StepReport advance();
  std::vector<SolverTrial> convergence(std::span<const SolverSettings> solvers);

  /// All fields; the particles get the dimensions of the simulation.
  void copyParticles(AnyParticles& host) const;
  ParticleNumbers numbers() const;
  double time() const;  // [s]
  std::int64_t step() const;
  std::size_t bytes() const;      // [B]
  std::size_t peakBytes() const;  // [B]

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace treacle
