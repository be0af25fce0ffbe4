#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/mph/viscosity_classes.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// The viscosities of particles from their shear rates, temperatures and factors, particle by particle; the shear
/// rates are those of mph_balance.hpp. Spans are in the backend's memory.

/// By material.
struct RheologyTable {
  Rheology of[maxMaterials];
  ShiftFactor shift[maxMaterials];
  std::span<const double> temperature{};  // per particle [K]; empty: no viscosity follows it
  std::span<const double> factor{};       // likewise, by which it is multiplied [-]; empty: 1

  static RheologyTable make(const Case& c);

  /// Of a particle i of material m at a shear rate of gamma [1/s], [Pa s].
  TREACLE_HD double viscosity(std::size_t i, int m, double rate) const {
    const double mu = of[m].viscosity(rate, temperature.empty() ? 1 : shift[m](temperature[i]));
    return factor.empty() ? mu : factor[i] * mu;
  }
};

/// Sets mu_i, and s_i mu_i, what MphPairs take as scale.
struct ViscosityTerms {
  RheologyTable table;
  double correction;  // [0, 1]: method.viscosity_correction
  std::span<const std::uint8_t> material;
  std::span<const double> rate;         // gamma [1/s]
  std::span<const double> share;        // the viscosity scale with a correction of 1 [-]
  std::span<double> viscosity, scaled;  // [Pa s]

  TREACLE_HD void set(std::size_t i) const {
    // None at all would look like a wall.
    viscosity[i] = std::fmax(table.viscosity(i, material[i], rate[i]), 1e-30);
    scaled[i] = viscosity[i] * (1 + correction * (share[i] - 1));
  }
};

/// Of the first particles, as many as there are rates.
template <class Backend>
void setViscosities(Context<Backend>&, const ViscosityTerms&);

/// Sets the class of a particle: fluid has a viscosity, walls are of their materials' class.
struct ClassTerms {
  ViscosityClasses classes;
  std::span<const std::uint8_t> material;
  std::span<const double> viscosity;  // of the fluid, ghosts included [Pa s]
  std::span<std::uint8_t> kind;

  TREACLE_HD void set(std::size_t i) const {
    kind[i] = i < viscosity.size() ? classes.of(material[i], viscosity[i]) : material[i];
  }
};
template <class Backend>
void setClasses(Context<Backend>&, const ClassTerms&);

/// What a particle's shear rate after a solve says: the rate that the next one is to take, and what it adds to the
/// sums of |change of mu| gamma^2 and mu gamma^2.
struct RateTerms {
  static constexpr int count = 2;

  RheologyTable table;
  std::span<const std::uint8_t> material;
  std::span<const double> last, found;  // rate that the solve took the viscosity of, and that of its result [1/s]
  std::span<const double> viscosity;    // of the solve [Pa s]
  std::span<double> next;               // may be `last`

  TREACLE_HD void add(std::size_t i, double* sums) const {
    next[i] = table.of[material[i]].nextRate(last[i], found[i]);
    const double mu = table.viscosity(i, material[i], next[i]), square = found[i] * found[i];
    sums[0] += std::fabs(mu - viscosity[i]) * square;
    sums[1] += mu * square;
  }
  /// The mean relative change of the viscosity, weighted with the dissipation.
  static double change(const std::array<double, count>& sums) { return sums[1] > 0 ? sums[0] / sums[1] : 0; }
};

/// Sets all rates; the change of the viscosity over all processes. The order of the sums depends on the number of
/// particles alone.
template <class Backend>
double nextRates(Context<Backend>&, const RateTerms&);

}  // namespace treacle
