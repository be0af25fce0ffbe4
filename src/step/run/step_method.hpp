#pragma once

#include "flow_state.hpp"
#include "method/staged_solver.hpp"
#include "treacle/model/state/balance.hpp"
#include "treacle/search/cell_owners.hpp"
#include "treacle/step/method/solver_trial.hpp"
#include "treacle/step/readings/diagnostics.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace treacle {

/// What a method does in a time step, in this order, on a state that it refers to.
template <int D, class Backend>
class StepMethod {
 public:
  virtual ~StepMethod() = default;

  virtual void sortParticles() = 0;
  virtual void findNeighbours() = 0;
  /// Densities of frame 0, where no step has been made.
  virtual void computeDensities() = 0;
  /// What comes before the linear system, for state.timeStep: ISPH's velocities without pressure, which take
  /// linear solves of their own where the viscosity is implicit. In phases of its own. Errors: RunError.
  virtual StagedReport predict() { return {}; }
  /// Everything that the linear system consists of, for state.timeStep.
  virtual void prepareSystem() = 0;
  virtual void preparePreconditioner() = 0;
  /// The linear system. Errors: RunError.
  virtual StagedReport solve() = 0;
  /// Solves the same system, once it is prepared, in another way from the same first guess, without any fallback.
  /// Solves the system of the step by other settings. The state does not change.
  virtual SolverTrial solveBy(const SolverSettings&) = 0;
  /// Leaves the velocities of the fluid at the end of the step in state.velocity.
  virtual void correctVelocities() {}
  /// The viscous force of walls on own fluid particles with these velocities [N/m3].
  virtual void wallFriction(std::span<Vec<D>> force) = 0;
  /// What the fluid moves with, once they are there.
  virtual std::span<const Vec<D>> transportVelocities() = 0;
  /// How far a particle can have gone in the step if none is faster than `speed` [m/s] at its end [m].
  virtual double longestWay(double speed) const = 0;
  /// Writes what the particles shall hold but for position and velocity, which are still those before the step.
  virtual void accept() = 0;
  /// The balance of the step that was accepted last, if the case wants it.
  virtual std::optional<Balance> balance() const { return {}; }
  /// What walls bear in that step, where the case wants it: per wall body, in the order of the case.
  virtual std::vector<WallLoad> loads() const { return {}; }
  /// The pressure on the patch of each probe WallPressure in that step [Pa].
  virtual std::vector<double> patchPressures() const { return {}; }
  /// How far pressures carry particles in the step at hand, in the mean, over what they bear
  /// (StiffnessLimits::most); 0 where they keep nothing.
  virtual double pressedWay() const { return 0; }
  /// Completes what the diagnostics of a step are made of.
  virtual void describe(DiagnosticsInput<D>&) const {}

  virtual const CellGrid<D>& grid() const = 0;
  /// Owners of cells since the last sort, if processes share the state.
  virtual const CellOwners<D>& owners() const = 0;
  virtual const MaterialTable& materials() const = 0;
  virtual std::size_t bytes() const = 0;
};

template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeMphStep(FlowState<D, Backend>& state);
template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeIsphStep(FlowState<D, Backend>& state);

}  // namespace treacle
