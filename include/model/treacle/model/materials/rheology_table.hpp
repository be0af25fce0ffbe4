#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/materials/state_table.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace treacle {

/// The viscosities of particles from their shear rates, temperatures, factors and states, particle by particle.
/// Spans and pointers are to a backend's memory.
struct RheologyTable {
  Rheology of[maxMaterials];  // by material
  ShiftFactor shift[maxMaterials];
  FrozenShare frozen[maxMaterials];
  StateTable states;
  std::span<const double> temperature{};  // per particle [K]; empty: no viscosity follows it
  std::span<const double> factor{};       // likewise, by which it is multiplied [-]; empty: 1
  const double* state[maxStates] = {};    // likewise, of the states; null: there is none
  double time = 0;                        // [s]
  std::span<const double> implicit{};     // likewise, what is added in a step [Pa s]; empty: nothing

  /// Adds the steps of formulas, for whose place in the backend's memory states.steps has to be set. Errors:
  /// InputError for expressions that are none.
  static RheologyTable make(const Case& c, std::vector<FormulaStep>& steps);

  /// What the first `count` particles carry.
  template <int D, class Backend>
  void read(const Particles<D, Backend>& p, std::size_t count, double now) {
    temperature = p.has.temperatures ? p.temperature.span().first(count) : std::span<const double>{};
    factor = p.has.viscosityFactors ? p.viscosityFactor.span().first(count) : std::span<const double>{};
    for (std::size_t k = 0; k < maxStates; ++k) state[k] = k < p.has.states ? p.states[k].data() : nullptr;
    time = now;
  }

  /// The variables of the formulas for particle i at a shear rate of gamma [1/s].
  TREACLE_HD void variables(std::size_t i, double rate, double* x) const {
    x[StateTable::Temperature] = temperature.empty() ? 0 : temperature[i];
    x[StateTable::ShearRate] = rate;
    x[StateTable::Time] = time;
    for (int k = 0; k < maxStates; ++k) x[StateTable::FirstState + k] = state[k] ? state[k][i] : 0;
  }

  /// Of a particle i of material m at a shear rate of gamma [1/s], [Pa s].
  TREACLE_HD double viscosity(std::size_t i, int m, double rate) const {
    const Factors f = factors(i, m, rate);
    return f.viscosity * of[m].viscosity(rate, f.shift, f.yield) + (implicit.empty() ? 0 : implicit[i]);
  }

  /// By what the volume of particle i is multiplied [-].
  TREACLE_HD double volume(std::size_t i, int m, double rate) const {
    if (!states.steps) return 1;
    double x[StateTable::variables];
    variables(i, rate, x);
    return states.volumeFactor(m, x);
  }

  /// Whether particles differ in slowness().
  bool hasSlowness() const { return !temperature.empty() || !factor.empty() || states.steps; }
  /// By what the viscosities and relaxation times of the elastic modes of particle i are multiplied [-]: what
  /// multiplies the viscosity of a Newtonian fluid.
  TREACLE_HD double slowness(std::size_t i, int m, double rate) const {
    const Factors f = factors(i, m, rate);
    return f.viscosity * f.shift;
  }

 private:
  struct Factors {
    double viscosity = 1, shift = 1, yield = 1;
  };
  TREACLE_HD Factors factors(std::size_t i, int m, double rate) const {
    Factors f;
    if (!factor.empty()) f.viscosity = factor[i];
    if (!temperature.empty()) {
      f.shift = shift[m](temperature[i]);
      f.viscosity *= frozen[m].viscosityFactor(temperature[i]);
    }
    if (!states.steps) return f;
    double x[StateTable::variables];
    variables(i, rate, x);
    f.viscosity *= states.viscosityFactor(m, x);
    f.yield = states.yieldFactor(m, x);
    if (f.yield < 0) f.viscosity = std::numeric_limits<double>::quiet_NaN();  // countUnsound() finds it
    return f;
  }
};

}  // namespace treacle
