#pragma once

#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/model/materials/enthalpy.hpp"
#include "treacle/step/method/freezing_terms.hpp"
#include "treacle/step/method/heat_terms.hpp"
#include "treacle/step/method/set_each.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace treacle {

/// The system of StepHeat where some material freezes: fields per own fluid particle.
struct FreezingSystem {
  double timeStep;  // [s]
  std::span<const std::uint8_t> material;
  std::span<const double> start;                      // T^k [K]
  std::span<const double> boundary, source, ofFluid;  // as in HeatSystemTerms
  std::span<double> extra, inverse, rhs, product;     // set here
  std::span<double> change, next;                     // likewise: T of the fluxes less T^k, and T^{k+1} [K]
};

/// Solves it (freezing_terms.hpp), and has what that takes.
template <class Backend>
class StepFreezing {
 public:
  explicit StepFreezing(const Case& c) : table_(EnthalpyTable::make(c.materials)), settings_(*c.heat) {
    for (const WallHeat& wall : wallHeat(c))
      for (const Enthalpy& h : table_.of) conductedAtWalls_.push_back(h.conducted(wall.temperature));
  }

  /// What the pairs conduct by, at the temperatures T of own particles; ghosts are filled. `material`: of all
  /// fluid particles.
  OwnConduction conduction(Context<Backend>& context, std::span<const std::uint8_t> material,
                           std::span<const double> T) {
    const std::size_t fluid = material.size();
    for (auto* field : {&started_, &conductivity_, &conducted_}) field->resize(context, fluid);
    copyValues(context, T, started_.data());
    fillGhosts(context, Held::Fluid, started_.data());
    setEach(context, ConductivityTerms{table_, material, started_.span(), conductivity_.span(), conducted_.span()},
            fluid);
    if (atWalls_.empty()) fromHost(context, std::span<const double>(conductedAtWalls_), atWalls_);
    return {started_.data(), conductivity_.data(), conducted_.data(), atWalls_.data()};
  }

  /// `product`: of a matrix with `extra` [W/(m3 K)]; it reads extra when it is called. Errors: RunError.
  template <class ProductWith>
  void solve(Context<Backend>& context, const FreezingSystem& s, const ProductWith& productWith,
             KrylovWorkspace<Backend>& krylov) {
    const std::size_t own = s.start.size();
    for (auto* field : {&temperature_, &gained_, &slope_}) field->resize(context, own);
    copyValues(context, s.start, temperature_.data());
    clearValues(context, gained_.span());
    const Product fluxes = productWith(s.boundary), a = productWith(s.extra);
    const Product k = [&](std::span<const double> r, std::span<double> z) {
      setEach(context, Scaled{s.inverse, r, z}, own);
    };
    double first = 0;
    for (int n = 0;; ++n) {
      fluxes(temperature_, s.product);
      const auto sums =
          sumFreezing(context, FreezingTerms{table_, s.timeStep, n >= newtonSteps, s.material, temperature_.span(),
                                             gained_.span(), s.boundary, s.source, s.product, s.ofFluid, s.rhs,
                                             slope_.span(), s.extra, s.inverse});
      const double left = sums[FreezingTerms::Left];
      if (n == 0) first = left;
      if (left <= settings_.tolerance * first || left <= rounding * sums[FreezingTerms::Size]) break;
      if (n == settings_.maxIterations) throw RunError(describeFreezingFailure(left / first, n, settings_));
      clearValues(context, s.change);
      // Half as far as the whole is to come, and no further than the next slopes can make use of.
      const double tolerance = std::clamp(0.25 * settings_.tolerance * first / left, 1e-16, 1e-4);
      const SolveReport report =
          conjugateGradient(context, {a, k, s.rhs, s.change}, {tolerance, settings_.maxIterations}, krylov);
      if (report.status != SolveStatus::Converged) throw RunError(describeHeatFailure(report, settings_));
      setEach(context,
              FreezingUpdate{table_, s.material, s.start, slope_.span(), s.change, gained_.span(),
                             temperature_.span()},
              own);
    }
    setEach(context, FreezingResult{table_, s.timeStep, s.material, s.start, s.source, s.product, s.next}, own);
    setEach(context, Difference{temperature_.span(), s.start, s.change}, own);
  }

  std::size_t bytes() const {
    std::size_t sum = atWalls_.bytes();
    for (const auto* field : {&started_, &conductivity_, &conducted_, &temperature_, &gained_, &slope_})
      sum += field->bytes();
    return sum;
  }

 private:
  // More are needed only where slopes go to and fro between particles.
  static constexpr int newtonSteps = 15;
  static constexpr double rounding = 1e-26;  // of temperatures, squared

  EnthalpyTable table_;
  HeatSettings settings_;
  std::vector<double> conductedAtWalls_;
  // Of OwnConduction: per fluid particle, and the same as conductedAtWalls_.
  Buffer<double, Backend> started_, conductivity_, conducted_, atWalls_;
  Buffer<double, Backend> temperature_, gained_, slope_;  // per own one: of FreezingTerms
};

}  // namespace treacle
