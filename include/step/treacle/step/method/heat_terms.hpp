#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/materials/enthalpy.hpp"
#include "treacle/mph/conduction.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// What a step of heat does fluid particle by fluid particle, per volume. It is solved for the change of the
/// temperatures,
///   (rho c_p / dt + boundary_i) dT_i + sum_j kappa_ij (dT_i - dT_j) = source_i - boundary_i T_i - sum_j kappa_ij
///   (T_i - T_j),
/// so that the tolerance is one of the change, and then what is left of the equation is added,
///   T^{k+1} = T^k + dT + dt / (rho c_p) r,
/// so that heat is conserved to rounding whatever the tolerance. Spans of own fluid in the backend's memory.

/// Constants of a step.
struct HeatConstants {
  static constexpr double stefanBoltzmann = 5.670374419e-8;  // [W/(m2 K4)], exact since 2019

  HeatTable table;
  double timeStep;  // [s]
  double ambient;   // [K]
  double transfer;  // [W/(m2 K)]
  double spacing;   // l [m]

  /// How far below a flat free surface the temperature that counts there is that of the fluid, extrapolated: by
  /// the flux through slabs of square lattices 0.64 l and 0.67 l for h l / k = 0.2 and 2, of cubic ones 0.68 l.
  /// The first row is at 0.5 l, and the second one, which has 3 to 6 % of the area, takes heat past it.
  static constexpr double depth = 0.66;  // [spacings]

  /// rho c_p / dt of material m [W/(m3 K)]
  TREACLE_HD double inertia(int m) const { return table.capacity[m] / timeStep; }
  /// From a first row at about T [K] through the free surface per area: what is convected, and what is radiated,
  /// linear around T, in series with the fluid between both. A fluid that does not conduct counts as stirred.
  TREACLE_HD HeatExchange surface(int m, double T) const {
    const double radiated = table.emissivity[m] * stefanBoltzmann, cube = T * T * T;
    const double ambient2 = ambient * ambient, k = table.conductivity[m];
    const double coefficient = transfer + 4 * radiated * cube;
    const double share = k > 0 ? 1 / (1 + coefficient * depth * spacing / k) : 1;
    return {share * coefficient, share * (transfer * ambient + radiated * (ambient2 * ambient2 + 3 * cube * T))};
  }
};

/// Sets the system but for the pairs, and its preconditioner, the inverse of its diagonal.
struct HeatSystemTerms {
  HeatConstants constants;
  std::span<const std::uint8_t> material;
  std::span<const double> T;        // T^k [K]
  std::span<const double> ofFluid;  // sum of kappa [W/(m3 K)]
  std::span<const HeatExchange> walls;
  std::span<const double> area;        // of the free surface [1/m], or empty
  std::span<const double> heating;     // by the viscosity and elastic modes [W/m3], or empty
  std::span<const double> ofStates;    // by the states of materials, likewise
  std::span<HeatExchange> surface;     // of the free surface; empty where area is
  std::span<double> boundary, source;  // [W/(m3 K)], [W/m3]
  std::span<double> extra, inverse;    // rho c_p / dt + boundary [W/(m3 K)]; 1 / diagonal

  TREACLE_HD void set(std::size_t i) const {
    HeatExchange sum = walls[i];
    if (!area.empty()) {
      const HeatExchange perArea = constants.surface(material[i], T[i]);
      surface[i] = {area[i] * perArea.coefficient, area[i] * perArea.gain};
      sum = {sum.coefficient + surface[i].coefficient, sum.gain + surface[i].gain};
    }
    boundary[i] = sum.coefficient;
    source[i] = sum.gain + (heating.empty() ? 0 : heating[i]) + (ofStates.empty() ? 0 : ofStates[i]);
    extra[i] = constants.inertia(material[i]) + sum.coefficient;
    inverse[i] = 1 / (extra[i] + ofFluid[i]);
  }
};

/// z = a + b, z = a - b, and z = a b.
struct Sum {
  std::span<const double> a, b;
  std::span<double> z;
  TREACLE_HD void set(std::size_t i) const { z[i] = a[i] + b[i]; }
};
struct Difference {
  std::span<const double> a, b;
  std::span<double> z;
  TREACLE_HD void set(std::size_t i) const { z[i] = a[i] - b[i]; }
};
struct Scaled {
  std::span<const double> a, b;
  std::span<double> z;
  TREACLE_HD void set(std::size_t i) const { z[i] = a[i] * b[i]; }
};

/// T^{k+1}, from T^k, dT, and the right-hand side and product of the system with dT.
struct HeatResult {
  HeatConstants constants;
  std::span<const std::uint8_t> material;
  std::span<const double> T, change, rhs, product;
  std::span<double> next;

  TREACLE_HD void set(std::size_t i) const {
    next[i] = T[i] + change[i] + (rhs[i] - product[i]) / constants.inertia(material[i]);
  }
};

/// What a particle adds to the heat balance of a step, per volume of a particle.
struct HeatSums {
  enum { Energy, Heating, Walls, Surface, count };

  HeatConstants constants;
  EnthalpyTable enthalpy;
  std::span<const std::uint8_t> material;
  std::span<const double> T, change, next;
  std::span<const double> heating;  // or empty
  std::span<const HeatExchange> walls, surface;

  TREACLE_HD void add(std::size_t i, double* sums) const {
    const double met = T[i] + change[i];  // what the boundaries exchanged heat with
    sums[Energy] += enthalpy.of[material[i]].at(next[i]);
    if (!heating.empty()) sums[Heating] += heating[i];
    sums[Walls] += walls[i].gain - walls[i].coefficient * met;
    if (!surface.empty()) sums[Surface] += surface[i].gain - surface[i].coefficient * met;
  }
};

/// Over own particles of all processes, in an order that depends on their number alone.
template <class Backend>
std::array<double, HeatSums::count> sumHeat(Context<Backend>&, const HeatSums& terms);

}  // namespace treacle
