#pragma once

#include "treacle/isph/isph_flow.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// Viscosity [Pa s] with which a straight velocity profile from a smooth wall to the speed `u` [m/s] of the fluid
/// at the distance `d` [m] has the shear stress of the law of the wall: u/u* = y for y = u* d/nu below
/// 11.53, and ln(9.8 y)/0.41 above (B. E. Launder, D. B. Spalding, Comput. Methods Appl. Mech. Eng. 3, 1974). At
/// least mu. `density` in kg/m3; `mu` [Pa s] must be positive.
TREACLE_HD inline double wallLawViscosity(double u, double d, double density, double mu) {
  constexpr double karman = 0.41, smooth = 9.8, laminar = 11.53;
  const double nu = mu / density, speed = std::fabs(u), reynolds = speed * d / nu;
  if (reynolds <= laminar * laminar) return mu;
  double y = std::sqrt(reynolds);  // u* d / nu, from reynolds = y u/u*
  for (int n = 0; n < 6; ++n) {    // Newton's method
    const double plus = std::log(smooth * y) / karman;
    y -= (y * plus - reynolds) / (plus + 1 / karman);
  }
  return std::fmax(mu, mu * y * y / reynolds);
}

/// The eddy viscosity of Smagorinsky's model (Mon. Weather Rev. 91, 1963), rho (C l)^2 |S| with |S|^2 = 2 S:S and
/// the strain rate S of a particle, and the viscosity between it and no-slip walls. Walls do not count in S
/// (SmoothFlow), because next to them the law of the wall stands for the steep part of the profile.
template <int D>
struct EddyTerm {
  static constexpr int values = 2 * D + 1;
  enum { Towards, Wall = D, Slopes = 2 * D };  // places of the sums
  const Vec<D>* velocity;                      // of fluid and active walls [m/s]
  const SmoothFlow<D>* flow;                   // of it
  float* eddyViscosity;                        // of IsphPairs [Pa s]
  float* wallViscosity;                        // likewise

  TREACLE_HD void fluid(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                        double*) const {}
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    const double slope = pairs.slope(r);
    const Vec<D> u = pairs.velocityAtSurface(j, d, velocity[j]);
    for (int k = 0; k < D; ++k) {
      sum[Towards + k] += slope * d[k];
      sum[Wall + k] += slope * u[k];
    }
    sum[Slopes] += slope;
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    double square = 0;
    for (int k = 0; k < D; ++k)
      for (int m = 0; m < D; ++m) {
        const double twice = flow[i].gradient(k, m) + flow[i].gradient(m, k);
        square += 0.5 * twice * twice;
      }
    const double density = pairs.density(i), most = pairs.mostEddyViscosity;
    const double length = pairs.mixingLength;
    eddyViscosity[i] = static_cast<float>(std::fmin(most, density * length * length * std::sqrt(square)));
    wallViscosity[i] = static_cast<float>(atWall(pairs, i, density, sum));
  }

 private:
  TREACLE_HD double atWall(const IsphPairs<D>& pairs, std::uint32_t i, double density, const double* sum) const {
    const double mu = pairs.pairViscosity(i, i);
    if (sum[Slopes] <= 0) return mu;
    Vec<D> towards, u;
    for (int k = 0; k < D; ++k) {
      towards[k] = sum[Towards + k] / sum[Slopes];
      u[k] = velocity[i][k] - sum[Wall + k] / sum[Slopes];
    }
    const double away = norm(towards);
    if (away > 0) u -= (dot(u, towards) / (away * away)) * towards;
    const double viscosity = wallLawViscosity(norm(u), pairs.wallDistance(away), density, mu);
    return std::fmin(viscosity, mu + pairs.mostEddyViscosity);
  }
};

}  // namespace treacle
