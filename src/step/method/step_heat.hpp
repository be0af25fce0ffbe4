#pragma once

#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "step_freezing.hpp"
#include "surface_heat.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/model/state/balance.hpp"
#include "treacle/mph/conduction.hpp"
#include "treacle/mph/free_surface.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/step/method/heat_terms.hpp"
#include "treacle/step/method/set_each.hpp"

#include <array>
#include <optional>
#include <vector>

namespace treacle {

/// The temperatures of a step of MPH-I: conduction, boundaries and heating in one implicit step, on the places at
/// the start of the step and with the velocities of its end. The system is symmetric positive definite and, unless
/// a step carries heat over many spacings, close to its diagonal: conjugate gradients with that as preconditioner.
template <int D, class Backend>
class StepHeat {
 public:
  StepHeat(const Case& c, const MphPairs<D>& pairs)
      : settings_(*c.heat),
        table_(HeatTable::make(c)),
        enthalpy_(EnthalpyTable::make(c.materials)),
        walls_(wallHeat(c)),
        surface_(SurfaceColour<D>::make(pairs)),
        surfaceCounts_(hasSurfaceHeat(c)) {
    if (c.freezes()) freezing_.emplace(c);
  }

  /// With state.velocity of the end of the step, ghosts included. `ofStates`: what states of materials set free
  /// per own particle [W/m3], or empty; `ofModes`: likewise the power of elastic stresses that no viscosity has.
  /// Errors: RunError.
  void solve(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> ofStates,
             std::span<const double> ofModes) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    resize(context, pairs);
    Conduction terms{table_, walls(context), state.particles.body.data(), nullptr};
    conductionScale<D>(context, pairs, terms, scale_.span().first(own));
    fillGhosts(context, Held::Fluid, scale_.data());
    terms.scale = scale_.data();
    const std::span<const double> T = state.particles.temperature.span().first(own);
    const std::span<const std::uint8_t> material = pairs.material.first(own);
    if (freezing_) terms.own = freezing_->conduction(context, pairs.material.first(pairs.fluidCount), T);
    conductionDiagonal<D>(context, pairs, terms, ofFluid_, ofWalls_);
    if (surfaceCounts_) surfaceArea<D>(context, pairs, surface_, area_);
    if (settings_.viscousHeating) {
      shearDissipation<D>(context, pairs, state.velocity, heating_);
      if (!ofModes.empty()) setEach(context, Sum{heating_, ofModes, heating_.span()}, own);
    }

    const HeatConstants constants{table_, state.timeStep, settings_.ambient, settings_.transfer, pairs.spacing};
    setEach(context,
            HeatSystemTerms{constants, material, T, ofFluid_, ofWalls_, area_, heating_, ofStates, ofSurface_,
                            boundary_, source_, extra_, inverse_},
            own);
    const auto conductExtra = [&](std::span<const double> extra) {
      return [&, extra](std::span<const double> x, std::span<double> y) {
        conduct<D>(context, pairs, terms, extra, withGhosts(context, x, withGhosts_), y);
      };
    };
    if (freezing_)
      freezing_->solve(context,
                       {state.timeStep, material, T, boundary_, source_, ofFluid_, extra_.span(), inverse_.span(),
                        rhs_.span(), product_.span(), change_.span(), next_.span()},
                       conductExtra, krylov_);
    else
      solveLinear(context, constants, material, T, conductExtra);
    if (state.theCase.needsBalance())
      sums_ = sumHeat(context,
                      HeatSums{constants, enthalpy_, material, T, change_, next_, heating_, ofWalls_, ofSurface_});
  }

  void accept(FlowState<D, Backend>& state) {
    copyValues(state.context, std::span<const double>(next_), state.particles.temperature.data());
  }

  /// The balance of the step that was solved last, for particles of that volume.
  HeatBalance balance(double volume) const {
    return {.energy = volume * sums_[HeatSums::Energy],
            .heating = volume * sums_[HeatSums::Heating],
            .walls = volume * sums_[HeatSums::Walls],
            .surface = volume * sums_[HeatSums::Surface]};
  }

  std::size_t bytes() const {
    std::size_t sum = ofWalls_.bytes() + ofSurface_.bytes() + wallBuffer_.bytes() + krylov_.bytes() +
                      (freezing_ ? freezing_->bytes() : 0);
    for (const auto* field : {&scale_, &ofFluid_, &area_, &heating_, &boundary_, &source_, &extra_, &inverse_,
                              &rhs_, &change_, &product_, &next_, &withGhosts_})
      sum += field->bytes();
    return sum;
  }

 private:
  void resize(Context<Backend>& context, const MphPairs<D>& pairs) {
    const std::uint32_t own = pairs.ownFluid();
    scale_.resize(context, pairs.fluidCount);
    for (auto* field : {&ofFluid_, &boundary_, &source_, &extra_, &inverse_, &rhs_, &change_, &product_, &next_})
      field->resize(context, own);
    ofWalls_.resize(context, own);
    if (settings_.viscousHeating) heating_.resize(context, own);
    if (!surfaceCounts_) return;
    area_.resize(context, own);
    ofSurface_.resize(context, own);
  }

  /// Where nothing freezes, the system is linear. Errors: RunError.
  template <class ProductWith>
  void solveLinear(Context<Backend>& context, const HeatConstants& constants,
                   std::span<const std::uint8_t> material, std::span<const double> T,
                   const ProductWith& conductExtra) {
    const std::size_t own = T.size();
    conductExtra(boundary_)(T, product_);
    setEach(context, Difference{source_, product_, rhs_.span()}, own);
    clearValues(context, change_.span());
    const Product a = conductExtra(extra_);
    const Product k = [&](std::span<const double> r, std::span<double> z) {
      setEach(context, Scaled{inverse_.span(), r, z}, own);
    };
    requireSolved(conjugateGradient(context, {a, k, rhs_, change_}, {settings_.tolerance, settings_.maxIterations},
                                    krylov_));
    a(change_, product_);
    setEach(context, HeatResult{constants, material, T, change_, rhs_, product_, next_}, own);
  }

  const WallHeat* walls(Context<Backend>& context) {
    if (wallBuffer_.empty()) fromHost(context, std::span<const WallHeat>(walls_), wallBuffer_);
    return wallBuffer_.data();
  }

  /// Errors: RunError.
  void requireSolved(const SolveReport& report) const {
    if (report.status != SolveStatus::Converged) throw RunError(describeHeatFailure(report, settings_));
  }

  HeatSettings settings_;
  HeatTable table_;
  EnthalpyTable enthalpy_;
  std::vector<WallHeat> walls_;
  SurfaceColour<D> surface_;
  bool surfaceCounts_;  // whether anything is exchanged there
  Buffer<WallHeat, Backend> wallBuffer_;
  // Per own fluid particle; scale_ per fluid particle, ghosts included.
  Buffer<double, Backend> scale_, ofFluid_, area_, heating_, boundary_, source_, extra_, inverse_, rhs_, change_,
      product_, next_, withGhosts_;
  Buffer<HeatExchange, Backend> ofWalls_, ofSurface_;
  KrylovWorkspace<Backend> krylov_;
  std::optional<StepFreezing<Backend>> freezing_;  // where some material freezes
  std::array<double, HeatSums::count> sums_{};
};

}  // namespace treacle
