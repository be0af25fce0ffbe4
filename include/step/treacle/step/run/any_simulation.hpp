#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/particles/any_particles.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// A simulation whose dimensions, backend and precision are chosen as it is made: by the case and its particles,
/// by the caller, and by the case's solver. Who runs cases goes through here; who looks into a step takes
/// Simulation. Members mean the same as those of Simulation.
///
/// Several processes may share a simulation. The first of them has the object, and uses it as if it were alone,
/// while Followers wait at it; the others are in serveSimulation(), and do their part of whatever is asked of it.
/// A process that cannot do its part ends the job, and says so.
class AnySimulation {
 public:
  /// `processes`: those that share it; null or one: it is alone. Errors: CaseError for a case that cannot be run,
  /// InputError for particles of other dimensions, a backend that this build does not have, or a case that
  /// processes cannot share, std::bad_alloc.
  AnySimulation(const Case& c, AnyParticles particles, BackendKind backend = BackendKind::Cpu,
                std::int64_t step = 0, double time = 0, const Communicator* processes = nullptr);
  ~AnySimulation();
  AnySimulation(AnySimulation&&) noexcept;

  StepReport advance();
  std::vector<SolverTrial> convergence(std::span<const SolverSettings> solvers);

  /// All fields; the particles get the dimensions of the simulation.
  void copyParticles(AnyParticles& host) const;
  ParticleNumbers numbers() const;
  FieldMemory field(FluidField field) const;
  void copyField(FluidField field, void* host) const;
  void giveFluid(const GivenFluid& given);
  void giveMotion(std::size_t body, const Body& as);
  std::vector<ProbeReading> measure(std::uint64_t probes) const;
  double time() const;  // [s]
  std::int64_t step() const;
  std::size_t bytes() const;      // [B]
  std::size_t peakBytes() const;  // [B]
  std::string linkName() const;

  /// What each of the processes has to do, and what it has told the others, in the order of ranks; one if it is
  /// alone.
  struct Share {
    std::uint64_t fluidParticles = 0;
    Communicator::Traffic traffic;
    double waiting = 0;               // of the time in exchanges, for others [s]; on devices, where that is known
    std::size_t peakBytes = 0;        // of device memory [B]
    std::uint64_t peakHostBytes = 0;  // of the process, whatever it has done so far [B]
  };
  std::vector<Share> shares() const;

  /// What a process does with the simulation beside its part of the steps: `order` and `number` mean what the
  /// first process and the duty of the others have agreed on.
  using Duty = std::function<void(AnySimulation& simulation, int order, std::int64_t number)>;
  /// At the first process: does this one's duty while the others do theirs (serveSimulation). A duty is collective
  /// as the members are: a RunError must be one of all processes.
  void everywhere(int order, std::int64_t number, const Duty& duty);
  /// In a duty alone; returns how many walls, the first ones, are this process's own.
  std::uint32_t copyOwnParticles(AnyParticles& host) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
  const Communicator* processes_ = nullptr;
};

/// At the first process: that the others are waiting for what its simulation asks of them, until this is gone.
class Followers {
 public:
  explicit Followers(const Communicator& processes) : processes_(processes) {}
  Followers(const Followers&) = delete;
  ~Followers();

 private:
  const Communicator& processes_;
};

/// At every other process: takes part in the simulation that the first one makes with the same arguments and
/// another part of the particles. Returns when its Followers are gone.
void serveSimulation(const Case& c, AnyParticles particles, BackendKind backend, std::int64_t step, double time,
                     const Communicator& processes, const AnySimulation::Duty& duty = {});

}  // namespace treacle
