#pragma once

#include "isph_failure.hpp"
#include "isph_solver.hpp"
#include "step_unknowns.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/isph_particles.hpp"
#include "treacle/isph/isph_sums.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// The velocities v* of a step of ISPH without pressure [O23 eq. (7)], by an explicit or an implicit viscous step,
/// in the accurate scheme with the forces of isph_flow.hpp.
template <int D, class Backend>
class IsphPredictor {
 public:
  /// Both must outlive this.
  IsphPredictor(FlowState<D, Backend>& state, const IsphPairs<D>& pairs)
      : state_(state),
        pairs_(pairs),
        viscousLimit_(explicitViscousLimit(pairs)),
        viscosity_(solveStages(solvedCase(state.theCase))) {}

  /// Finds densities and, where the scheme or the turbulence needs it, flow().
  void start(const DensityTerm<D>& density) {
    density_ = density;
    if (isViscous() || hasFlow()) fillGhosts(state_.context, Held::Fluid, state_.particles.velocity.data());
    if (!hasFlow()) return;
    flow_.resize(state_.context, pairs_.fluidCount);
    const SmoothFlowTerm<D> flow{state_.particles.velocity.data(), state_.particles.pressure.data(), flow_.data()};
    sumOnFluid(state_.context, pairs_, BothTerms<DensityTerm<D>, SmoothFlowTerm<D>>{density, flow});
    fillGhosts(state_.context, Held::Fluid, flow_.data());
  }

  /// After start(), in phases of its own. `scratch`: a number per own fluid particle. Errors: RunError.
  StagedReport predict(const CellRanges<Backend>& ranges, std::span<double> scratch) {
    if (isImplicit()) return solveViscosity(ranges, scratch);
    state_.phases.run(state_.context, phases::coefficients, [&] {
      takeWalls();
      if (hasFlow())
        sumOnFluid(state_.context, pairs_, term());
      else
        sumOnFluid(state_.context, pairs_, BothTerms<DensityTerm<D>, PredictorTerm<D>>{density_, term()});
    });
    return {};
  }

  /// Once more in the same step, with the velocities that walls have now, and the forces.
  StagedReport follow(std::span<double> scratch, bool withForces) {
    takeWalls();
    StagedReport total;
    if (!withForces && (!isViscous() || !pairs_.noSlip)) return total;  // walls do not matter
    if (isImplicit()) {
      computeSource();
      for (int k = 0; k < D; ++k) total.follow(solveComponent(k, scratch));
    } else {
      sumOnFluid(state_.context, pairs_, term());
    }
    return total;
  }

  /// Of the fluid at the start of the step.
  const SmoothFlow<D>* flow() const { return flow_.data(); }
  /// That of the explicit step's viscous forces, if any.
  const SmoothFlow<D>* viscousFlow() const { return isImplicit() ? nullptr : dampedFlow(); }
  /// v* of fluid, for ghosts once they are filled; the velocities of active walls.
  Buffer<Vec<D>, Backend>& velocity() { return velocity_; }
  /// The velocities that the viscous forces of the step are of.
  std::span<const Vec<D>> viscousVelocity() const {
    return isImplicit() ? velocity_.span() : std::span<const Vec<D>>(state_.particles.velocity);
  }
  bool isViscous() const { return std::isfinite(viscousLimit_); }

  std::size_t bytes() const {
    std::size_t sum = velocity_.bytes() + flow_.bytes() + viscosity_.bytes();
    for (const auto& component : component_) sum += component.bytes();
    return sum;
  }

 private:
  bool isImplicit() const {
    return isViscousStepImplicit(state_.theCase.method.isph.viscosity, viscousLimit_, state_.timeStep);
  }

  const SmoothFlow<D>* dampedFlow() const { return pairs_.accurate ? flow_.data() : nullptr; }
  bool hasFlow() const { return pairs_.accurate || pairs_.mixingLength > 0; }
  PredictorTerm<D> term() {
    return {state_.particles.velocity.data(), velocity_.data(), isViscous(), dampedFlow()};
  }

  void takeWalls() {
    const std::uint32_t n = pairs_.fluidCount, active = pairs_.activeCount;
    velocity_.resize(state_.context, active);
    copyValues(state_.context, std::span<const Vec<D>>(state_.particles.velocity).subspan(n, active - n),
               velocity_.data() + n);
  }

  /// v* of (rho/dt - mu lap) v* = rho/dt v + rho g, one component after the other.
  StagedReport solveViscosity(const CellRanges<Backend>& ranges, std::span<double> scratch) {
    state_.phases.run(state_.context, phases::coefficients, [&] {
      takeWalls();
      if (!hasFlow()) sumOnFluid(state_.context, pairs_, density_);
      viscosity_.prepareMatrix(state_.context, pairs_, ranges, ViscousRow<D>{});
      computeSource();
    });
    state_.phases.run(state_.context, phases::coarse, [&] { viscosity_.preparePreconditioner(state_.context); });
    StagedReport total;
    state_.phases.run(state_.context, phases::solve, [&] {
      for (int k = 0; k < D; ++k) total.follow(solveComponent(k, scratch));
    });
    return total;
  }

  void computeSource() {
    ViscousSourceTerm<D> term{state_.particles.velocity.data(), {}, dampedFlow()};
    for (int k = 0; k < D; ++k) {
      component_[k].resize(state_.context, pairs_.ownFluid());
      term.source[k] = component_[k].data();
    }
    sumOnFluid(state_.context, pairs_, term);
  }

  StagedReport solveComponent(int k, std::span<double> scratch) {
    const std::uint32_t n = pairs_.ownFluid();
    takeComponent<D>(state_.context, std::span<const Vec<D>>(state_.particles.velocity).first(n), k, scratch);
    const StagedReport report = viscosity_.solve(state_.context, component_[k], scratch);
    requireConverged(state_, "viscosity", report);
    putComponent<D>(state_.context, scratch, k, velocity_.span().first(n));
    return report;
  }

  FlowState<D, Backend>& state_;
  const IsphPairs<D>& pairs_;
  double viscousLimit_;                   // [s]
  DensityTerm<D> density_{};              // of the step
  Buffer<Vec<D>, Backend> velocity_;      // v*
  Buffer<SmoothFlow<D>, Backend> flow_;   // with ghosts
  Buffer<double, Backend> component_[D];  // of the viscous step's right-hand side
  IsphSolver<D, Backend, ViscousRow<D>> viscosity_;
};

}  // namespace treacle
