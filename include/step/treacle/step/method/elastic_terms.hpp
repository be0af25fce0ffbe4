#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/product.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/materials/elastic_constants.hpp"

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

/// What particles have in a step of dt [s].
template <int D>
struct ElasticState {
  ElasticTable table;
  double timeStep;  // [s]
  std::span<const std::uint8_t> material;
  const SymmetricBlock<D>* conformation[maxElasticModes];  // at the start; null: there is no such mode
  std::span<const Block<D>> gradient;                      // of the velocity [1/s]

  /// By which viscosity the system has the stress of particle i [Pa s].
  TREACLE_HD double implicitViscosity(std::size_t i) const {
    double sum = 0;
    for (int k = 0; k < maxElasticModes; ++k)
      if (const ElasticConstants& mode = table.of[material[i]][k]; mode.modulus > 0)
        sum += mode.implicitViscosity(timeStep, conformation[k][i]);
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

/// Sets that viscosity, without gradients.
template <int D>
struct ImplicitViscosity {
  ElasticState<D> state;
  std::span<double> viscosity;

  TREACLE_HD void set(std::size_t i) const { viscosity[i] = state.implicitViscosity(i); }
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
    const double implicit = state.implicitViscosity(i);
    SymmetricBlock<D> stress{};
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s) stress(r, s) = -implicit * (L(r, s) + L(s, r));
    for (int k = 0; k < maxElasticModes; ++k) {
      const ElasticConstants& mode = state.table.of[state.material[i]][k];
      if (mode.modulus == 0) continue;
      const SymmetricBlock<D> c = mode.advanced(L, state.timeStep, state.conformation[k][i]);
      for (int r = 0; r < D; ++r)
        for (int s = r; s < D; ++s) stress(r, s) += mode.modulus * (c(r, s) - (r == s));
    }
    carried[i] = product<D>(stress, correction[i]);
  }
};
template <int D, class Backend>
void expectStress(Context<Backend>&, const ExpectedStress<D>& terms);

/// Sets the conformations at the end of the step.
template <int D>
struct AdvancedModes {
  ElasticState<D> state;
  SymmetricBlock<D>* next[maxElasticModes];

  /// Adds 1 to the sum if they are not finite.
  TREACLE_HD void add(std::size_t i, double* sum) const {
    const Block<D> L = state.strain(i);
    bool finite = true;
    for (int k = 0; k < maxElasticModes; ++k) {
      if (!next[k]) continue;
      const ElasticConstants& mode = state.table.of[state.material[i]][k];
      const SymmetricBlock<D> c = mode.modulus > 0 ? mode.advanced(L, state.timeStep, state.conformation[k][i])
                                                   : SymmetricBlock<D>::identity();
      for (const double x : c.a) finite = finite && x - x == 0;
      next[k][i] = c;
    }
    if (!finite) *sum += 1;
  }
};
/// Sets them; the number of particles whose conformations are not finite, over all processes.
template <int D, class Backend>
double advanceModes(Context<Backend>&, const AdvancedModes<D>& terms);

}  // namespace treacle
