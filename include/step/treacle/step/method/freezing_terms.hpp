#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/materials/enthalpy.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// What a step of heat does fluid particle by fluid particle where some material freezes, per volume. The step
/// solves
///   (H(T^{k+1}) - H(T^k)) / dt + boundary_i T_i + sum_j kappa_ij (T_i - T_j) = source_i
/// by Newton's method for the enthalpies H, as linear systems for the temperatures: what is gained with the slope
/// dH/dT of a particle goes to its enthalpy, and its temperature follows from that (C. R. Swaminathan, V. R.
/// Voller, Metall. Trans. B 23, 1992). Then the enthalpy gets what the fluxes of the last temperatures bring, so
/// that heat is conserved to rounding whatever the tolerance. Spans of own fluid in the backend's memory.

/// Sets what OwnConduction has of particles at their temperatures.
struct ConductivityTerms {
  EnthalpyTable table;
  std::span<const std::uint8_t> material;
  std::span<const double> T;                  // [K]
  std::span<double> conductivity, conducted;  // [W/(m K)], [W/m]

  TREACLE_HD void set(std::size_t i) const {
    const Enthalpy& h = table.of[material[i]];
    conductivity[i] = h.conductivity(T[i]);
    conducted[i] = h.conducted(T[i]);
  }
};

/// What is left of the equation, and the linear system for the next change of the temperatures but for the pairs.
struct FreezingTerms {
  enum { Left, Size, count };  // sums of squares: of what is left as a change of temperature, and of T [K2]

  EnthalpyTable table;
  double timeStep;  // [s]
  /// With the least slopes of the materials in place of those at T: slower, but from every start.
  bool least;
  std::span<const std::uint8_t> material;
  std::span<const double> T;                                   // so far [K]
  std::span<const double> gained;                              // H(T) - H(T^k) [J/m3]
  std::span<const double> boundary, source, product, ofFluid;  // as in HeatSystemTerms; the product with T
  std::span<double> rhs, slope, extra, inverse;  // [W/m3], [J/(m3 K)]; slope / dt + boundary; 1 / diagonal

  TREACLE_HD void add(std::size_t i, double* sums) const {
    const Enthalpy& h = table.of[material[i]];
    rhs[i] = source[i] - product[i] - gained[i] / timeStep;
    slope[i] = least ? h.leastSlope() : h.slope(T[i]);
    extra[i] = slope[i] / timeStep + boundary[i];
    inverse[i] = 1 / (extra[i] + ofFluid[i]);
    // As the change that it asks of this particle alone: rounding leaves some parts of T, whatever the fluxes are.
    const double left = rhs[i] / (h.leastSlope() / timeStep + boundary[i] + ofFluid[i]);
    sums[Left] += left * left;
    sums[Size] += T[i] * T[i];
  }
};

/// Sets these; the sums over own particles of all processes, in an order that depends on their number alone.
template <class Backend>
std::array<double, FreezingTerms::count> sumFreezing(Context<Backend>&, const FreezingTerms& terms);

/// Takes a change of the temperatures.
struct FreezingUpdate {
  EnthalpyTable table;
  std::span<const std::uint8_t> material;
  std::span<const double> start, slope, change;  // T^k [K]
  std::span<double> gained, T;

  TREACLE_HD void set(std::size_t i) const {
    const Enthalpy& h = table.of[material[i]];
    gained[i] += slope[i] * change[i];
    T[i] = h.temperature(h.at(start[i]) + gained[i]);
  }
};

/// T^{k+1}, from T^k and the fluxes of the last temperatures.
struct FreezingResult {
  EnthalpyTable table;
  double timeStep;
  std::span<const std::uint8_t> material;
  std::span<const double> start, source, product;
  std::span<double> next;

  TREACLE_HD void set(std::size_t i) const {
    const Enthalpy& h = table.of[material[i]];
    next[i] = h.temperature(h.at(start[i]) + timeStep * (source[i] - product[i]));
  }
};

}  // namespace treacle
