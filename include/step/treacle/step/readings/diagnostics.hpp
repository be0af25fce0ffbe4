#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/mph/cover.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace treacle {

/// The state of the fluid particles; spans in the backend's memory, all of the same length.
template <int D>
struct DiagnosticsInput {
  std::span<const Vec<D>> position;  // [m]
  std::span<const Vec<D>> velocity;  // [m/s]
  std::span<const std::uint8_t> material;
  MaterialTable materials;
  FrameForce<D> frame;
  double spacing = 0;  // [m]
  // Of ISPH, else empty.
  std::span<const double> density{};        // <rho> / rho
  std::span<const std::uint8_t> surface{};  // 1: at the free surface
  // Of MPH-I, else empty.
  std::span<const double> numberDensity{};
  double restDensity = 0;              // n_0 [-]
  double ownDensity = 0;               // w(0), which n leaves out [-]
  std::span<const double> pressure{};  // of the last step [Pa]
  std::span<const double> open{};      // of numberDensity(), empty where it is not known
  // What walls make up of the density, empty where it is not known, and what the neighbours in a full lattice do.
  std::span<const double> wallDensity{};
  double neighbourDensity = 0;

  double ownShare() const { return restDensity > 0 ? ownDensity / restDensity : 0; }
};

/// What a particle adds to the diagnostics.
template <int D>
struct DiagnosticsTerm {
  double mass[maxMaterials];  // of a particle, by material [kg; per metre of depth in 2D]
  double volume;
  FrameForce<D> frame;
  Vec<D> up;

  static DiagnosticsTerm make(const DiagnosticsInput<D>& in) {
    DiagnosticsTerm t{};
    t.volume = std::pow(in.spacing, D);  // [K23 eq. (11)]
    for (int m = 0; m < in.materials.count; ++m) t.mass[m] = in.materials.density[m] * t.volume;
    t.frame = in.frame;
    t.up[D - 1] = 1;  // without gravity the last axis counts as height
    if (const double g = norm(in.frame.gravity); g > 0) t.up = in.frame.gravity * (-1 / g);
    return t;
  }

  /// Of particle i; means are sums until the end.
  TREACLE_HD Diagnostics operator()(const DiagnosticsInput<D>& in, std::size_t i) const {
    const Vec<D>&x = in.position[i], &u = in.velocity[i];
    const double speed2 = norm2(u), m = mass[in.material[i]];
    Diagnostics d{0.5 * m * speed2, m * frame.potential(x), x[0], dot(up, x), std::sqrt(speed2)};
    d.gravityPower = volume * dot(frame.on(x, in.materials.density[in.material[i]]), u);
    if (!in.wallDensity.empty()) d.insideWalls = in.wallDensity[i] > 0 && in.wallDensity[i] >= in.neighbourDensity;
    if (!in.numberDensity.empty()) {
      const double excess = in.numberDensity[i] - in.restDensity;
      if (excess > 0) {
        d.excessDensity = excess / in.restDensity;
        d.elasticEnergy = 0.5 * volume * in.materials.bulkModulus[in.material[i]] * excess * excess;
      }
    }
    if (!in.open.empty()) {
      const double ratio = in.numberDensity[i] / in.restDensity;
      const double walls = in.wallDensity.empty() ? 0 : in.wallDensity[i] / in.restDensity;
      if (Cover::isInside(in.open[i], ratio, walls)) {
        d.interiorParticles = 1;
        d.insideVolume = Cover::of(in.open[i], ratio).rest / ratio;
        d.compression = in.pressure[i] / in.materials.bulkModulus[in.material[i]];
      }
    }
    if (in.density.empty()) return d;
    d.excessDensity = in.density[i] > 1 ? in.density[i] - 1 : 0;
    d.meanDensityRatio = in.density[i];
    d.interiorParticles = !in.surface[i];
    d.meanDensityError = in.surface[i] ? 0 : std::abs(in.density[i] - 1);
    return d;
  }
};

/// Of no particle: what any other is joined to.
TREACLE_HD inline Diagnostics noDiagnostics() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {0, 0, -infinity, -infinity};
}

/// Of two sets of particles together.
TREACLE_HD inline Diagnostics joined(const Diagnostics& a, const Diagnostics& b) {
  return {a.kineticEnergy + b.kineticEnergy,
          a.potentialEnergy + b.potentialEnergy,
          a.frontX < b.frontX ? b.frontX : a.frontX,
          a.top < b.top ? b.top : a.top,
          a.maxSpeed < b.maxSpeed ? b.maxSpeed : a.maxSpeed,
          a.meanDensityRatio + b.meanDensityRatio,
          a.meanDensityError + b.meanDensityError,
          a.interiorParticles + b.interiorParticles,
          a.excessDensity + b.excessDensity,
          a.elasticEnergy + b.elasticEnergy,
          a.insideWalls + b.insideWalls,
          a.gravityPower + b.gravityPower,
          a.insideVolume + b.insideVolume,
          a.compression + b.compression};
}

/// Sums into means; `count` of particles. n + w(0) is the sum that is proportional to the density: n alone changes
/// by a quarter more in 2D and by a tenth more in 3D. `own`: w(0) / n_0.
inline Diagnostics averaged(Diagnostics d, std::size_t count, double own) {
  if (count > 0) {
    d.meanDensityRatio /= static_cast<double>(count);
    d.excessDensity /= static_cast<double>(count);
  }
  if (d.interiorParticles > 0) d.meanDensityError /= d.interiorParticles, d.compression /= d.interiorParticles;
  if (d.insideVolume > 0) {
    d.meanDensityRatio = (d.interiorParticles / d.insideVolume + own) / (1 + own);
    d.meanDensityError = std::abs(1 / d.meanDensityRatio - 1);
  }
  return d;
}

/// Sums and extremes over the particles; the order of the sums depends on their number alone. Of no particles:
/// zeros, and minus infinity for the two coordinates.
template <int D, class Backend>
Diagnostics computeDiagnostics(Context<Backend>&, const DiagnosticsInput<D>&);

}  // namespace treacle
