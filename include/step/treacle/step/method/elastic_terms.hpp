#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/product.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/materials/elastic_constants.hpp"
#include "treacle/model/materials/rheology_table.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// What elastic modes do particle by particle. Spans and pointers are to own fluid in the backend's memory.

/// The modes of the materials.
struct ElasticTable {
  ElasticConstants of[maxMaterials][maxElasticModes];

  static ElasticTable make(const Case& c) {
    ElasticTable t{};
    for (std::size_t m = 0; m < c.materials.size(); ++m)
      for (std::size_t k = 0; k < c.materials[m].elastic.size(); ++k)
        t.of[m][k] = ElasticConstants::of(c.materials[m].elastic[k]);
    return t;
  }
};

/// Sets RheologyTable::slowness.
struct Slowness {
  RheologyTable table;
  std::span<const std::uint8_t> material;
  std::span<const double> rate;  // shear rate [1/s]
  std::span<double> slowness;    // [-]

  TREACLE_HD void set(std::size_t i) const { slowness[i] = table.slowness(i, material[i], rate[i]); }
};

/// What particles have in a step of dt [s].
template <int D>
struct ElasticState {
  ElasticTable table;
  double timeStep;  // [s]
  std::span<const std::uint8_t> material;
  const SymmetricBlock<D>* conformation[maxElasticModes];  // at the start; null: there is no such mode
  std::span<const Block<D>> gradient;                      // of the velocity [1/s]
  std::span<const double> slowness;                        // of the modes [-]; empty: 1

  /// Mode k of particle i.
  TREACLE_HD ElasticConstants mode(std::size_t i, int k) const {
    const ElasticConstants& given = table.of[material[i]][k];
    return slowness.empty() ? given : given.slowed(slowness[i]);
  }
  /// Adds the stress of mode k with the conformation c [Pa].
  TREACLE_HD static void addStress(const ElasticConstants& mode, const SymmetricBlock<D>& c,
                                   SymmetricBlock<D>& stress) {
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s) stress(r, s) += mode.modulus * (c(r, s) - (r == s));
  }
  /// Minus the stress that the system has as a viscosity, for the gradient L without its trace [Pa].
  TREACLE_HD SymmetricBlock<D> lessImplicit(std::size_t i, const Block<D>& L) const {
    const double implicit = implicitViscosity(i);
    SymmetricBlock<D> stress{};
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s) stress(r, s) = -implicit * (L(r, s) + L(s, r));
    return stress;
  }

  /// By which viscosity the system has the stress of particle i [Pa s].
  TREACLE_HD double implicitViscosity(std::size_t i) const {
    double sum = 0;
    for (int k = 0; k < maxElasticModes; ++k)
      if (const ElasticConstants own = mode(i, k); own.modulus > 0)
        sum += own.implicitViscosity(timeStep, conformation[k][i]);
    return sum;
  }

  /// L without its trace: the fluid is incompressible, and the bulk viscosity lets it change its volume a little.
  TREACLE_HD Block<D> strain(std::size_t i) const {
    Block<D> L = gradient[i];
    double trace = 0;
    for (int k = 0; k < D; ++k) trace += L(k, k);
    for (int k = 0; k < D; ++k) L(k, k) -= trace / D;
    return L;
  }
};

/// Sets that viscosity, without gradients, and adds others.
template <int D>
struct ImplicitViscosity {
  ElasticState<D> state;
  std::span<const double> others;  // [Pa s]; empty: none
  std::span<double> viscosity;

  TREACLE_HD void set(std::size_t i) const {
    viscosity[i] = state.implicitViscosity(i) + (others.empty() ? 0 : others[i]);
  }
};
template <int D, class Backend>
void setImplicitViscosity(Context<Backend>&, const ImplicitViscosity<D>& terms);

/// Sets the stress of the end of the step as far as it is known before the flow: that of the expected gradient,
/// less what the system has of it as a viscosity; times B (elasticity.hpp) [Pa].
template <int D>
struct ExpectedStress {
  ElasticState<D> state;
  std::span<const SymmetricBlock<D>> correction;
  std::span<Block<D>> carried;

  TREACLE_HD void set(std::size_t i) const {
    const Block<D> L = state.strain(i);
    SymmetricBlock<D> stress = state.lessImplicit(i, L);
    for (int k = 0; k < maxElasticModes; ++k)
      if (const ElasticConstants mode = state.mode(i, k); mode.modulus > 0)
        state.addStress(mode, mode.advanced(L, state.timeStep, state.conformation[k][i]), stress);
    carried[i] = product<D>(stress, correction[i]);
  }
};
template <int D, class Backend>
void expectStress(Context<Backend>&, const ExpectedStress<D>& terms);

/// Sets the conformations at the end of the step, and the power of the stress of that end beside what the system
/// has as a viscosity.
template <int D>
struct AdvancedModes {
  ElasticState<D> state;
  SymmetricBlock<D>* next[maxElasticModes];
  std::span<double> power;  // [W/m3]; empty: nobody asks

  /// Adds 1 to the sum if they are not finite.
  TREACLE_HD void add(std::size_t i, double* sum) const {
    const Block<D> L = state.strain(i);
    bool finite = true;
    for (int k = 0; k < maxElasticModes; ++k) {
      if (!next[k]) continue;
      const ElasticConstants mode = state.mode(i, k);
      const SymmetricBlock<D> c = mode.modulus > 0 ? mode.advanced(L, state.timeStep, state.conformation[k][i])
                                                   : SymmetricBlock<D>::identity();
      for (const double x : c.a) finite = finite && x - x == 0;
      next[k][i] = c;
    }
    if (!power.empty()) power[i] = powerOf(i, L);
    if (!finite) *sum += 1;
  }

 private:
  TREACLE_HD double powerOf(std::size_t i, const Block<D>& L) const {
    SymmetricBlock<D> stress = state.lessImplicit(i, L);
    for (int k = 0; k < maxElasticModes; ++k)
      if (next[k]) state.addStress(state.mode(i, k), next[k][i], stress);
    double sum = 0;
    for (int r = 0; r < D; ++r)
      for (int s = 0; s < D; ++s) sum += stress(r, s) * L(r, s);
    return sum;
  }
};
/// Sets them; the number of particles whose conformations are not finite, over all processes.
template <int D, class Backend>
double advanceModes(Context<Backend>&, const AdvancedModes<D>& terms);

}  // namespace treacle
