#pragma once

#include "isph_failure.hpp"
#include "isph_solver.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/closed_regions.hpp"
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

  /// Solves for the pressure. Errors: RunError.
  StagedReport solve(IsphSolver<D, Backend, PressureRow<D>>& solver, const IsphPairs<D>& pairs,
                     const ClosedRegions<Backend>& closed) {
    takeLevels(state_.context, closed, Level::Mean, source_.span());
    pressure_.resize(state_.context, pairs.ownFluid());
    clearValues(state_.context, pressure_.span());
    const StagedReport report = solver.solve(state_.context, source_, pressure_, nullptr, looser);
    requireConverged(state_, "arrangement", report);
    return report;
  }

  /// Has the corrector find what particles move with: v* corrected by the sum of this pressure and that of the
  /// flow [Pa].
  void addTo(CorrectorTerm<D>& term, const IsphPairs<D>& pairs, const ClosedRegions<Backend>& closed,
             std::span<const std::uint8_t> surface, std::span<const double> flow) {
    Context<Backend>& context = state_.context;
    both_.resize(context, pairs.fluidCount);
    transport_.resize(context, pairs.ownFluid());
    const std::span<double> own = both_.span().first(pairs.ownFluid());
    addPressures(context, flow, pressure_, own);
    takeLevels(context, closed, Level::Least, own);
    settlePressure(context, surface, pairs.outside, !pairs.negativePressure, own);
    fillGhosts(context, Held::Fluid, both_.data());
    term.moving = both_.data();
    term.transport = transport_.data();
  }

  /// That, at most longestShift away from where `velocity`, that at the end of the step, leads.
  std::span<const Vec<D>> limited(const IsphPairs<D>& pairs, std::span<const Vec<D>> velocity) {
    limitTransport<D>(state_.context, pairs.spacing, pairs.timeStep, velocity, transport_);
    return transport_.span();
  }

  std::size_t bytes() const { return source_.bytes() + pressure_.bytes() + both_.bytes() + transport_.bytes(); }

 private:
  /// Times the tolerance for |r|^2 / |b|^2: more would not show in where particles are.
  static constexpr double looser = 1e8;

  FlowState<D, Backend>& state_;
  Buffer<double, Backend> source_;
  Buffer<double, Backend> pressure_;  // [Pa]
  Buffer<double, Backend> both_;      // and that of the flow, with ghosts [Pa]
  Buffer<Vec<D>, Backend> transport_;
};

}  // namespace treacle
