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
///
/// What is left of the forces along the surface comes of how its particles stand, and moves them without end. It
/// is shared among neighbours, twice, by pair forces that are central (what keeps particles apart is not):
///
///   f_i += sum_j k_ij (1 - (e.n)^2) e (e.(f_j - f_i)),   k = K [1 - r^2/h^2]_+,   n along m_i + m_j
///
/// n being shorter than 1 where m is noise. With K a particle of a full lattice takes, along the surface, just its
/// neighbours' mean. Not near walls, where forces along the surface are to be.
///
/// At walls the surface ends in a contact line. There G is continued as if the surface went on behind the wall,
/// and the wall holds what the stress pulls off it and pulls along itself as the contact angle says.

/// What a fluid particle has of fluid and of walls around it; sums of r^2 gradient are shares of a full lattice's.
template <int D>
struct SurfaceSums {
  Vec<D> fluid, wall;  // parts of G [1/m]
  double filled;       // with the share of the fluid
  double walls;        // of walls
  double pull;         // of walls, each with what it pulls along itself over gamma
};

template <int D>
struct SurfaceTerms {
  double inverseSquare = 0;      // 1/h^2 [1/m2]
  double gradientFactor = 0;     // 8 A / h^2, where A makes the sum over a full lattice 1 [1/m2]
  double shareFactor = 0;        // 1 over the sum of r^2 gradient over a full lattice
  double noise2 = 0;             // square of a |G| that particles in disorder have inside of the fluid [1/m2]
  double coreRadius = 0;         // r_0 [m]
  double coreFactor = 0;         // k / r_0^2 [1/m2]
  double evenFactor = 0;         // K
  double evenNoise = 0;          // |m|^2 that tells no direction, since particles in disorder have it [Pa]
  double tension[maxMaterials];  // gamma [N/m]
  double pull[maxMaterials];     // of a wall of the material along itself, over gamma

  static SurfaceTerms make(const Case& c);

  /// grad w = gradient d, d = x_j - x_i; r2 = d.d
  template <class Real>
  TREACLE_HD Real gradient(const Real& r2) const {
    const Real part = positivePart(1.0 - inverseSquare * r2);
    return gradientFactor * (part * part * part);
  }
  /// The share that a neighbour fills, from its gradient.
  template <class Real>
  TREACLE_HD Real share(const Real& gradient, const Real& r2) const {
    return shareFactor * gradient * r2;
  }
  /// What is to be multiplied by -(|m_i|^2 + |m_j|^2) d.
  template <class Real>
  TREACLE_HD Real core(const Real& inverseDistance) const {
    return coreFactor * positivePart(coreRadius * inverseDistance - 1.0);
  }
  /// m of a particle that shares forces along the surface, and never quite zero: its length may be rounding alone.
  TREACLE_HD Vec<D> sharing(int material, const SurfaceSums<D>& s, const Vec<D>& m) const {
    if (s.walls > 0 || tension[material] == 0) return {};
    const double least2 = 1e-12 * evenNoise;
    if (norm2(m) > least2) return m;
    Vec<D> small{};
    small[0] = sqrt(least2);
    return small;
  }
  /// The part k of the difference of their forces that two neighbours share.
  template <class Real>
  TREACLE_HD Real evening(const Real& r2) const {
    return evenFactor * positivePart(1.0 - inverseSquare * r2);
  }
  /// m of a particle, 8/3 gamma |G| being |m|^2 where |G| is more than noise. Of what lies along a wall the wall
  /// hides its share.
  TREACLE_HD Vec<D> slope(int material, const SurfaceSums<D>& s) const {
    Vec<D> g = s.fluid + s.wall;
    const double size2 = norm2(s.wall);
    if (size2 > 0) g += (g - s.wall * (dot(g, s.wall) / size2)) * (s.walls / (1 - s.walls));
    return g * sqrt(8.0 / 3.0 * tension[material] / sqrt(norm2(g) + noise2));
  }
  /// The force of the walls on a particle that the fluid's stress gives `ofFluid` [N/m3].
  TREACLE_HD Vec<D> ofWalls(const SurfaceSums<D>& s, const Vec<D>& m, const Vec<D>& ofFluid) const {
    const double size = norm(s.wall), m2 = norm2(m);
    if (!(size > 0 && m2 > 0)) return {};
    const Vec<D> inward = s.wall * (1 / size), along = m - inward * dot(m, inward);
    const double sine = norm(along) / sqrt(m2);  // of the angle between surface and wall
    if (!(sine > 0)) return {};
    const double line = 2 * m2 * size * fmin(1.0, s.filled / (1 - s.walls));
    const double away = -dot(ofFluid, inward), most = line * sine * sine;
    const double held = away < 0 ? 0 : away < most ? away : most;
    return inward * held - along * (line * s.pull / (s.walls * sqrt(m2)));
  }
};

/// |m_i|^2 per volume is 4/3 of the energy of the surface, gamma per area.
inline constexpr double surfaceEnergyShare = 0.75;

/// Per own fluid particle the sums and m_i [Pa^1/2]; `free` is m_i, too, but zero where walls are around.
template <int D>
void surfaceSlope(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<SurfaceSums<D>> sums,
                  std::span<Vec<D>> m, std::span<Vec<D>> free);
template <int D>
void surfaceSlope(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<SurfaceSums<D>> sums,
                  std::span<Vec<D>> m, std::span<Vec<D>> free);

/// Per own fluid particle [N/m3]: the force of stress and walls; `apart`, what keeps particles apart; and, unless
/// it is empty, `ofWalls`, that of walls alone over what they fill of the particle's surroundings. m of all fluid,
/// ghosts included.
template <int D>
void surfaceForces(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<const SurfaceSums<D>> sums,
                   std::span<const Vec<D>> m, std::span<Vec<D>> force, std::span<Vec<D>> apart,
                   std::span<Vec<D>> ofWalls = {});
template <int D>
void surfaceForces(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,
                   std::span<const SurfaceSums<D>> sums, std::span<const Vec<D>> m, std::span<Vec<D>> force,
                   std::span<Vec<D>> apart, std::span<Vec<D>> ofWalls = {});

/// y_i += f_i and what the particle shares of the forces along the surface with its neighbours, and apart_i unless
/// `apart` is empty, per own fluid particle [N/m3]. f and `free` of all fluid, ghosts included; where `free` is
/// zero nothing is shared.
template <int D>
void evenAlongSurface(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<const Vec<D>> free,
                      std::span<const Vec<D>> f, std::span<Vec<D>> y, std::span<const Vec<D>> apart = {});
template <int D>
void evenAlongSurface(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<const Vec<D>> free,
                      std::span<const Vec<D>> f, std::span<Vec<D>> y, std::span<const Vec<D>> apart = {});

/// Sets y per wall particle of the list to the reaction, as `ofWalls` has it of all fluid, ghosts included, and
/// adds it to `load` [N/m3].
template <int D>
void surfaceOnWalls(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, const ClusterListView& walls,
                    std::span<const Vec<D>> ofWalls, std::span<Vec<D>> y, std::span<Vec<D>> load);
template <int D>
void surfaceOnWalls(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, const ClusterListView& walls,
                    std::span<const Vec<D>> ofWalls, std::span<Vec<D>> y, std::span<Vec<D>> load);

}  // namespace treacle
