#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/materials/rheology_table.hpp"
#include "treacle/mph/viscosity_classes.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// The viscosities of particles (RheologyTable); the shear rates are those of mph_balance.hpp. Spans are in the
/// backend's memory.

/// Sets mu_i, and s_i mu_i, what MphPairs take as scale.
struct ViscosityTerms {
  RheologyTable table;
  double correction;  // [0, 1]: method.viscosity_correction
  std::span<const std::uint8_t> material;
  std::span<const double> rate;         // gamma [1/s]
  std::span<const double> share;        // the viscosity scale with a correction of 1 [-]
  std::span<double> viscosity, scaled;  // [Pa s]

  TREACLE_HD void set(std::size_t i) const {
    const double mu = table.viscosity(i, material[i], rate[i]);
    viscosity[i] = mu >= 0 && mu < 1e-30 ? 1e-30 : mu;  // none at all would look like a wall
    scaled[i] = viscosity[i] * (1 + correction * (share[i] - 1));
  }
};

/// Of the first particles, as many as there are rates.
template <class Backend>
void setViscosities(Context<Backend>&, const ViscosityTerms&);

/// How many of these viscosities are negative or not finite, over all processes.
template <class Backend>
double countUnsound(Context<Backend>&, std::span<const double> viscosity);

/// Sets by what the volumes of particles are multiplied, and counts those that the sums over neighbours are not
/// made for: the spacing would differ too much.
struct VolumeTerms {
  static constexpr double least = 0.75, most = 4.0 / 3;

  RheologyTable table;
  std::span<const std::uint8_t> material;
  std::span<const double> rate;  // gamma [1/s]
  std::span<double> volume;      // [-]

  TREACLE_HD void add(std::size_t i, double* sum) const {
    volume[i] = table.volume(i, material[i], rate[i]);
    if (!(volume[i] >= least && volume[i] <= most)) *sum += 1;
  }
};

/// Sets all; how many are out of bounds, over all processes.
template <class Backend>
double setVolumes(Context<Backend>&, const VolumeTerms&);

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
