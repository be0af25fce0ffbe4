#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/mph/particle_viscosity.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// Which share of a particle, a cube of the spacing, is in the part that a probe looks at.
template <int D>
struct PartWeight {
  Vec<D> low{}, high{};      // of a box [m]
  Vec<D> point{}, normal{};  // of a plane [m], [-]
  Vec<D> period{};           // of the domain; 0: none [m]
  double inverseSpacing = 0;
  int material = -1;  // of it alone; -1: all
  enum Plane { None, Behind, Across } plane = None;

  /// Of a probe that is summed.
  static PartWeight of(const Probe& probe, const Case& c);

  /// What is Across counts by a hat of two spacings to either side, which adds up to 1 over the layers of a
  /// lattice [1/m]; else [-].
  TREACLE_HD double operator()(const Vec<D>& x, int m) const {
    if (material >= 0 && m != material) return 0;
    double weight = 1;
    for (int k = 0; k < D; ++k)
      weight *= share((x[k] - low[k]) * inverseSpacing) * share((high[k] - x[k]) * inverseSpacing);
    if (plane == None || weight == 0) return weight;
    Vec<D> from = x - point;
    if (plane == Behind) return weight * share(-dot(from, normal) * inverseSpacing);
    for (int k = 0; k < D; ++k)
      if (period[k] > 0) from[k] -= period[k] * rint(from[k] / period[k]);
    const double distance = dot(from, normal) * inverseSpacing;
    return weight * std::fmax(0.0, 1 - 0.5 * std::fabs(distance)) * 0.5 * inverseSpacing;
  }

 private:
  /// Of a cube whose centre is so far inside, in spacings.
  TREACLE_HD static double share(double inside) { return std::fmin(std::fmax(inside + 0.5, 0.0), 1.0); }
};

/// What own fluid particles add to the sums; spans are in the backend's memory.
template <int D>
struct PartTerms {
  PartWeight<D> weight;
  RheologyTable viscosities;
  double density[maxMaterials];      // [kg/m3]
  double volume = 0;                 // of a particle [m3; m2 in 2D]
  std::span<const Vec<D>> position;  // [m]
  std::span<const Vec<D>> velocity;  // [m/s]
  std::span<const double> pressure;  // [Pa]
  std::span<const std::uint8_t> material;
  std::span<const double> shearRate;    // [1/s], or empty
  std::span<const double> temperature;  // [K], or empty

  TREACLE_HD void add(std::size_t i, double* sums) const {
    const int m = material[i];
    const Vec<D>&x = position[i], &u = velocity[i];
    const double v = weight(x, m) * volume;
    if (v == 0) return;
    const double mass = v * density[m], rate = shearRate.empty() ? 0 : shearRate[i];
    sums[0] += v;
    sums[1] += mass;
    for (int k = 0; k < D; ++k) {
      sums[2 + k] += mass * x[k];
      sums[5 + k] += v * u[k];
      sums[8 + k] += mass * u[k];
    }
    sums[11] += v * pressure[i];
    sums[12] += v * viscosities.viscosity(i, m, rate);
    sums[13] += v * rate;
    if (!temperature.empty()) sums[14] += v * temperature[i];
  }
};

/// Over all processes, in an order that depends on the number of particles alone.
template <int D, class Backend>
PartSums sumPart(Context<Backend>&, const PartTerms<D>&);

}  // namespace treacle
