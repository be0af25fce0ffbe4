#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Surface tension of free surfaces as a stress along them, a continuum surface stress (docs/surface-tension.md):
///
///   sigma_i = |m_i|^2 I - m_i m_i^T [Pa],   m_i = G_i sqrt(8/3 gamma / |G_i|),   G_i = sum_j grad w_ij
///   f_i = sum_j (sigma_i + sigma_j) grad w_ij - (|m_i|^2 + |m_j|^2) k [r_0 - r]_+ e / r_0^2 [N/m3]
///
/// with w = A (1 - r^2/h^2)^4, d = x_j - x_i = r e. G is not zero near a free surface alone, whose normal it has;
/// walls are in it like fluid. The stress has no component along it, so that a plane surface bears no force. The
/// forces are those of pairs of fluid, equal and opposite. Across a cut through a plane surface they add up to the
/// integral of 8/3 gamma c dc, the colour c, of which G is the gradient, rising from 1/2 at the surface to 1: that
/// is gamma. A tension lets particles gather; the second term, with k = 0.5 and r_0 = 0.95 l, keeps those of the
/// surface apart.
template <int D>
struct SurfaceTerms {
  double inverseSquare = 0;      // 1/h^2 [1/m2]
  double gradientFactor = 0;     // 8 A / h^2, where A makes the sum over a full lattice 1 [1/m2]
  double noise2 = 0;             // square of a |G| that particles in disorder have inside of the fluid [1/m2]
  double coreRadius = 0;         // r_0 [m]
  double coreFactor = 0;         // k / r_0^2 [1/m2]
  double tension[maxMaterials];  // gamma [N/m]

  static SurfaceTerms make(const Case& c);

  /// grad w = gradient d, d = x_j - x_i; r2 = d.d
  template <class Real>
  TREACLE_HD Real gradient(const Real& r2) const {
    const Real part = positivePart(1.0 - inverseSquare * r2);
    return gradientFactor * (part * part * part);
  }
  /// What is to be multiplied by -(|m_i|^2 + |m_j|^2) d.
  template <class Real>
  TREACLE_HD Real core(const Real& inverseDistance) const {
    return coreFactor * positivePart(coreRadius * inverseDistance - 1.0);
  }
  /// m of a particle with the sum G, 8/3 gamma |G| being |m|^2 where |G| is more than noise.
  TREACLE_HD Vec<D> slope(int material, const Vec<D>& g) const {
    const double steepness = std::sqrt(norm2(g) + noise2);
    return g * std::sqrt(8.0 / 3.0 * tension[material] / steepness);
  }
};

/// |m_i|^2 per volume is 4/3 of the energy of the surface, gamma per area.
inline constexpr double surfaceEnergyShare = 0.75;

/// m_i per own fluid particle [Pa^1/2].
template <int D>
void surfaceSlope(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<Vec<D>> m);
template <int D>
void surfaceSlope(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<Vec<D>> m);

/// y_i += f_i per own fluid particle [N/m3]; m of all fluid, ghosts included.
template <int D>
void addSurfaceTension(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<const Vec<D>> m,
                       std::span<Vec<D>> y);
template <int D>
void addSurfaceTension(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<const Vec<D>> m,
                       std::span<Vec<D>> y);

}  // namespace treacle
