#pragma once

#include "isph_failure.hpp"
#include "isph_solver.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/isph_particles.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "treacle/model/motion/shifting.hpp"

#include <span>

namespace treacle {

/// How the particles of the accurate scheme of ISPH keep their density. An error of the density gives them another
/// pressure, beside that of the flow and of the same matrix, which moves them and leaves their velocities alone.
/// So velocities and pressures of the flow have none of its noise.
template <int D, class Backend>
class IsphArrangement {
 public:
  /// The state must outlive this.
  explicit IsphArrangement(FlowState<D, Backend>& state) : state_(state) {}

  /// For PressureSourceTerm, of own fluid.
  double* source(std::uint32_t ownFluid) {
    source_.resize(state_.context, ownFluid);
    return source_.data();
  }

  /// Solves for the pressure, `closed` where no particle is at a free surface. Errors: RunError.
  StagedReport solve(IsphSolver<D, Backend, PressureRow<D>>& solver, const IsphPairs<D>& pairs, bool closed) {
    if (closed) takeLevel(state_.context, Level::Mean, source_);
    pressure_.resize(state_.context, pairs.fluidCount);
    const std::span<double> own = pressure_.span().first(pairs.ownFluid());
    clearValues(state_.context, own);
    const StagedReport report = solver.solve(state_.context, source_, own, nullptr, looser);
    requireConverged(state_, "arrangement", report);
    return report;
  }

  /// What particles move with: v* corrected by both pressures. `flow`: that of the flow [Pa]; `predicted`: v*, and
  /// velocities of walls; `velocity`: of own fluid at the end of the step.
  std::span<Vec<D>> transport(const IsphPairs<D>& pairs, bool closed, std::span<const std::uint8_t> surface,
                              std::span<const double> flow, const Vec<D>* predicted,
                              std::span<const Vec<D>> velocity) {
    Context<Backend>& context = state_.context;
    const std::span<double> own = pressure_.span().first(pairs.ownFluid());
    addPressure(context, flow.first(own.size()), own);
    if (closed) takeLevel(context, Level::Least, own);
    settlePressure(context, surface, closed || !pairs.negativePressure, own);
    fillGhosts(context, Held::Fluid, pressure_.data());
    transport_.resize(context, own.size());
    sumOnFluid(context, pairs, CorrectorTerm<D>{pressure_.data(), pressure_.data(), predicted, transport_.data()});
    limitTransport<D>(context, pairs.spacing, pairs.timeStep, velocity, transport_);
    return transport_.span();
  }

  std::size_t bytes() const { return source_.bytes() + pressure_.bytes() + transport_.bytes(); }

 private:
  /// Times the tolerance for |r|^2 / |b|^2: more would not show in where particles are.
  static constexpr double looser = 1e6;

  FlowState<D, Backend>& state_;
  Buffer<double, Backend> source_;
  Buffer<double, Backend> pressure_;  // of the arrangement, then of both together, with ghosts [Pa]
  Buffer<Vec<D>, Backend> transport_;
};

}  // namespace treacle
