#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/device_link.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/model/state/balance.hpp"
#include "treacle/step/method/solver_trial.hpp"
#include "treacle/step/readings/probe_reading.hpp"
#include "treacle/step/run/fluid_access.hpp"
#include "treacle/step/run/watch.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// Sums and extremes of the state over the fluid particles.
struct Diagnostics {
  double kineticEnergy = 0;    // sum of m |u|^2 / 2 [J; per metre of depth in 2D]
  double potentialEnergy = 0;  // -sum of m g.x, zero at the origin [J; per metre of depth in 2D]
  double frontX = 0;           // largest x [m]
  double top = 0;              // largest coordinate against gravity [m]
  double maxSpeed = 0;         // [m/s]
  // Of the accurate scheme of MPH-I: the density of the fluid inside over that of its material, by particles whose
  // places are not open (Cover); the share of its volume that it has gained or lost; the number of these
  // particles. Zero where there are none. Of ISPH: the mean of <rho> / rho; that of |<rho> / rho - 1| over the
  // particles that are not at the free surface; the number of these.
  double meanDensityRatio = 0;
  double meanDensityError = 0;
  double interiorParticles = 0;
  // For the watch (step/watch.hpp).
  double excessDensity = 0;  // mean of [<rho> / rho - 1]_+, for MPH-I of [n / n_0 - 1]_+
  double elasticEnergy = 0;  // sum of l^d kappa [n - n_0]_+^2 / 2 of MPH-I [J; per metre of depth in 2D]
  double insideWalls = 0;    // particles whose neighbourhood is filled by walls alone
  double gravityPower = 0;   // sum of m g.u [W; per metre of depth in 2D]
  double insideVolume = 0;   // of MPH-I: sum over the particles inside of their volumes, over l^d
  double compression = 0;    // of MPH-I: mean of p / kappa inside, by which pressures make the fluid denser
};

/// Wall-clock seconds of one step, or summed over steps.
struct PhaseSeconds {
  double search = 0;        // cell keys, sort, permutation, cell ranges
  double lists = 0;         // neighbour lists
  double coefficients = 0;  // densities, right-hand side, operator coefficients (assembly included)
  double coarse = 0;        // preconditioner set-up: diagonals, coarse operators
  double solve = 0;         // Krylov iterations
  double update = 0;        // pressure, motion, diagnostics

  double total() const { return search + lists + coefficients + coarse + solve + update; }
  PhaseSeconds& operator+=(const PhaseSeconds& o) {
    search += o.search, lists += o.lists, coefficients += o.coefficients;
    coarse += o.coarse, solve += o.solve, update += o.update;
    return *this;
  }
};

/// Of a case with inflows or outflows, after the step: fluid particles, and what has come and gone since its
/// start.
struct FlowReport {
  std::uint64_t particles = 0;
  FlowCount in, out;
};

/// Of a case with gas, after the step.
struct GasReport {
  std::uint64_t pockets = 0;
  double volume = 0;    // of all [m3; m2 in 2D]
  double pressure = 0;  // in the largest one, above that of the air [Pa]
};

struct StepReport {
  std::int64_t step = 0;  // number of steps done
  double time = 0;        // [s], after the step
  double timeStep = 0;    // [s]
  // Over which velocities have changed: times the powers of the balance it is energies [s].
  double velocityStep = 0;
  double error = 0;      // by which automatic steps are chosen (StepControl)
  int rejected = 0;      // longer steps that were tried before, with larger errors or without a solution
  int iterations = 0;    // of all linear solves, those of ISPH's implicit viscosity and of rejected steps
                         // included, and of all ways to try them
  double residual = 0;   // |r|^2 / |b|^2 at the end of the last solve
  int fallbacks = 0;     // ways that failed (solveStages)
  std::string failures;  // which, and why
  Diagnostics diagnostics;
  Watched watched;
  std::vector<std::string> warnings;  // of the watch
  std::vector<std::string> notes;     // what the run has changed by itself
  std::optional<Balance> balance;     // with OutputSettings::balance
  std::vector<WallLoad> loads;        // per wall body of the case, where one has a probe, or with a balance
  std::vector<double> patches;        // pressures of the probes WallPressure, in the order of the case [Pa]
  std::optional<FlowReport> flow;     // where the case is open
  std::optional<GasReport> gas;       // where it has gas
  std::vector<RigidBody> rigid;       // per body of the case, after the step, where some are rigid
  PhaseSeconds seconds;
};

/// A simulation: x^{k+1} = x^k + dt u^{k+1} with u^{k+1} from the implicit step of MPH-I [K23 eqs. (13)-(16)] or
/// the projection of ISPH [O23 eqs. (7)-(11)]. On the device the step runs from the first sort to the last
/// velocity; the host sees scalars. Results do not depend on the number of OpenMP threads, and the same run gives
/// the same bits.
template <int D, class Backend = Cpu>
class Simulation {
 public:
  /// `particles`: the state at `time` after `step` steps. `processes`: those that share the simulation; null or
  /// one: it is alone. All of them make it with the same arguments, but for the particles, of which each brings
  /// some, whichever (ParticlePart); and they call the same members in the same order.
  /// Errors: InputError for a case that cannot be shared (requireShareable), and where there are more processes
  /// than parts of the fluid; std::bad_alloc.
  Simulation(const Case& c, Particles<D> particles, std::int64_t step = 0, double time = 0,
             const Communicator* processes = nullptr);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  /// One time step. Errors: RunError with the diagnosis (no convergence, a value not finite, a particle outside
  /// an open domain, a bound of the watch); particles() and time() then still hold the last good state, that
  /// before the step.
  StepReport advance();

  /// Solves the linear system of the next step (ISPH: the pressure equation) by each of these solvers, from the
  /// first guess of the case and without fallbacks. They must fit the method and the case's neighbours. The step
  /// itself is still to be made, and gives the same bits as without. Errors: RunError where the system cannot be
  /// set up; a solve that fails is a result.
  std::vector<SolverTrial> convergence(std::span<const SolverSettings> solvers);

  /// Particles in the backend's memory: walls at rest that are far from all that moves (DistantWalls) are not
  /// there, nor, of several processes, the fluid that others own.
  const Particles<D, Backend>& particles() const;
  /// All fields of all particles; waits until the data are there. Of several processes the first gets them; the
  /// others' `host` is not touched.
  void copyParticles(Particles<D>& host) const;
  ParticleNumbers numbers() const;  // of these
  /// What the probes whose bits are set read now, but for loads. Of several processes the first gets it.
  /// Collective. Errors: std::bad_alloc.
  std::vector<ProbeReading> measure(std::uint64_t probes) const;
  /// Of several processes each gets what it is to show: its own fluid, ghosts with their positions, and walls, of
  /// which so many as are returned, the first ones, are its own, and the others those in reach. Every particle is
  /// one process's. Fields that walls do not have are undefined. Collective.
  std::uint32_t copyOwnParticles(Particles<D>& host) const;
  /// A field of the fluid where it lies; on a device once all that writes it is done.
  FieldMemory field(FluidField field) const;
  /// The same, copied to the host, where there is to be room for it.
  void copyField(FluidField field, void* host) const;
  /// Changes the state between steps. With other positions or velocities the flow has no memory of earlier steps,
  /// and the watch begins anew; pressures and densities stay those of the last step. Errors: InputError, for a
  /// simulation that processes share as well; std::bad_alloc. The state is then as before.
  void giveFluid(const GivenFluid& given);
  /// A body of the case moves from now on as this one does, which is where it is now (model/steering.hpp). Errors:
  /// InputError for a simulation that processes share.
  void giveMotion(std::size_t body, const Body& as);
  double time() const;  // [s]
  std::int64_t step() const;
  std::size_t bytes() const;      // memory held [B]
  std::size_t peakBytes() const;  // largest amount of device memory in use at one time [B]; 0 on the CPU
  /// What the device has told those of other processes, and by what (DeviceLink::name); nothing where it is alone.
  DeviceLink::Spent linkSpent() const;
  std::string linkName() const;
  Diagnostics diagnostics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Simulation<2, Cpu>;
extern template class Simulation<3, Cpu>;
extern template class Simulation<2, Cuda>;
extern template class Simulation<3, Cuda>;

}  // namespace treacle
