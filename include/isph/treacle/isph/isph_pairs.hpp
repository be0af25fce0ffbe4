#pragma once

#include "treacle/core/floored_inverse.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/model/geometry/seen_face.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/particles/smoothing_kernel.hpp"
#include "treacle/search/material_particles.hpp"
#include "treacle/search/neighbour_rows.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// Where a fluid particle stands.
struct Place {
  enum : std::uint8_t {
    Inside,
    Surface,  // at the free surface; it has an equation, in which missing neighbours have the pressure zero
    Free,     // it has no equation; its pressure is zero
  };
};

/// The particles at the free surface.
///
/// Published scheme: those with few neighbours, or with neighbours on one side. The density is below `sparse` of
/// that of a full lattice, or below `dense` with a lack of neighbours |sum V grad W| above `oneSided`, in units of
/// 1/l. The first catches spray and threads, the second sheets and surfaces, and not the hollows that open for a
/// few steps inside a splashing body. They are free.
///
/// Accurate scheme: those that miss `least` of a full lattice's neighbours. Particles miss the more of them the
/// more their neighbours lack on one side, or many of them: not at all up to the first value of a pair, and all
/// that is missing from the second on.
///
/// In both, single particles jammed into walls have no equation to take a pressure from. Particles with less than
/// fewest() fluid neighbours (a corner has 7 in 2D and 16 in 3D) are free.
struct SurfaceCriterion {
  double sparse = 0.75, dense = 1.05, oneSided = 0.2;
  double lack[2] = {0.05, 0.15}, many[2] = {0.15, 0.25}, least = 0.1;
  TREACLE_HD static constexpr int fewest(int dimensions) { return dimensions == 2 ? 4 : 8; }

  /// What counts as missing of the share of the neighbours that a particle does not have. `lackOf` in 1/l.
  TREACLE_HD double missing(double lackOf, double share) const {
    return std::fmax(ramp(lackOf, lack), ramp(share, many)) * std::fmax(0.0, share);
  }
  TREACLE_HD static double ramp(double x, const double (&between)[2]) {
    return std::fmin(1.0, std::fmax(0.0, (x - between[0]) / (between[1] - between[0])));
  }
};

/// sum += c d d^T, upper triangle by rows.
template <int D>
TREACLE_HD inline void addSquare(double c, const Vec<D>& d, double* sum) {
  for (int a = 0, n = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++n) sum[n] += c * d[a] * d[b];
}

/// The matrix of such a sum.
template <int D>
TREACLE_HD inline SymmetricBlock<D> squareOf(const double* sum) {
  SymmetricBlock<D> result;
  for (int n = 0; n < D * (D + 1) / 2; ++n) result.a[n] = sum[n];
  return result;
}

/// Shares of a particle's density that walls make up.
struct WallContact {
  double touching = 0;    // with a flat wall whose first layer is one spacing away
  double pressed = 0.35;  // 0.3 spacings nearer
  double inside = 0.6;    // on the first layer; three walls that meet come to 0.5
};

/// For the density of the accurate scheme: the window of Kaiser and Bessel [R. M. Lewitt, J. Opt. Soc. Am. A 7,
/// 1990] of order 1 with the taper 9, sqrt(s) I_1(9 sqrt(s)) / I_1(9) with s = 1 - q^2, to within 4e-6. In
/// lattices that are stretched by exp(0.35) across each other the density is right to 0.0012, with the cubic
/// spline to 0.005.
struct RowWindow {
  TREACLE_HD static double at(double s) {
    return s * (0.00462392 +
                s * (0.03780282 +
                     s * (0.20252082 + s * (0.04222768 + s * (0.6873731 + s * (-0.3014167 + s * 0.32686486))))));
  }
};

/// What the sums of ISPH read: sorted particles, their neighbours and the constants of the case.
template <int D>
struct IsphPairs : MaterialParticles<D> {
  NeighbourRowsView fluidOfFluid;  // FluidOfFluid
  std::uint64_t fluidEntries = 0;  // of these rows
  NeighbourRowsView wallsOfFluid;  // WallsOfFluid
  NeighbourRowsView fluidOfWalls;  // FluidOfWalls
  SmoothingKernel<D> kernel{};
  SurfaceCriterion surface;
  FrameForce<D> frame{};
  double volume = 0;                           // of a particle, l^D [m^D]
  double latticeDensity = 0;                   // sum of V W over a full lattice [-]
  double latticeWeight = 0;                    // sum of densityWeight over one
  double latticeLaplacian = 0;                 // sum of 2 slope over one [1/m2]
  double leastDensity = 0, mostViscosity = 0;  // of fluids [kg/m3], [Pa s]
  double mostDiffusivity = 0;                  // of their momentum, next to walls, too [m2/s]
  WallContact contact;
  double timeStep = 0;                        // [s]
  double alpha = 0;                           // [-]
  bool noSlip = true;                         // walls hold the fluid by its viscosity
  bool negativePressure = false;              // or cut to zero
  bool accurate = true;                       // the scheme
  static constexpr double leastMoment = 0.3;  // as what lesser eigenvalues of M count (DensityTerm)
  // Of the accurate scheme, per fluid particle, by DensityTerm and AcrossWallsTerm:
  SymmetricBlock<D, float>* renormalisation = nullptr;  // B [-]
  SymmetricBlock<D, float>* acrossWalls = nullptr;      // B' [-]; B where surfaces are not known
  float* missing = nullptr;                             // missingShare
  const double* outside = nullptr;                      // outsidePressure, per own fluid particle; null: 0
  // With a model of turbulence, per fluid particle, by EddyTerm:
  double mixingLength = 0;         // C l of Smagorinsky's model; 0: laminar [m]
  double mostEddyViscosity = 0;    // that the explicit viscous step bears [Pa s]
  double meanDistance = 0;         // of the neighbours in a wall half a spacing away, across it [m]
  float* eddyViscosity = nullptr;  // [Pa s]
  float* wallViscosity = nullptr;  // towards walls, instead of that of the materials [Pa s]

  /// Of a neighbour in the density, which is their sum over latticeWeight.
  TREACLE_HD double densityWeight(double r) const {
    if (!accurate) return volume * kernel.value(r);
    const double q = r / kernel.radius();
    return q < 1 ? RowWindow::at(1 - q * q) : 0;
  }
  /// V |W'| / r [1/m2]: V grad_i W = slope (x_j - x_i).
  TREACLE_HD double slope(const Distance& r) const { return volume * kernel.slope(r); }
  /// Of two fluid particles, with the eddies around them [Pa s].
  TREACLE_HD double viscosityBetween(std::uint32_t i, std::uint32_t j) const {
    const double mu = this->isOneSubstance() ? this->onlyViscosity() : this->pairViscosity(i, j);
    return eddyViscosity ? mu + 0.5 * (eddyViscosity[i] + eddyViscosity[j]) : mu;
  }
  /// Of a fluid particle and a wall at d, multiplied so that with their difference of velocities the fluid meets
  /// the wall's velocity at its surface: by wallFactor, or by 2, as in a mirror, where the surface is not known or
  /// a law of the wall has the viscosity. Zero: the wall does not hold the fluid [Pa s].
  TREACLE_HD double viscosityAtWall(std::uint32_t fluid, std::uint32_t wall, const Vec<D>& d) const {
    if (!noSlip) return 0;
    if (wallViscosity) return 2 * wallViscosity[fluid];
    if (!(this->pairViscosity(fluid, wall) > 0)) return 0;
    const bool known = this->wallSurface && norm2(this->surfaceOf(wall).face[0]) > 0;
    return (known ? wallFactor(this->surfaceOf(wall), d, this->spacing, 0) : 2) *
           this->pairViscosity(fluid, fluid);
  }
  /// The part across the wall's surface of d, from a fluid particle to a wall; d where the surface is not known.
  TREACLE_HD Vec<D> across(std::uint32_t wall, const Vec<D>& d) const {
    if (!this->wallSurface) return d;
    const SeenFace<D> face = seenFace(this->surfaceOf(wall), d);
    return face.exists() ? face.across(d) : d;
  }
  /// Distance from a flat wall whose particles are `mean` away in the mean, across the wall; right at half a
  /// spacing and at the kernel's radius.
  TREACLE_HD double wallDistance(double mean) const {
    const double radius = kernel.radius(), half = 0.5 * this->spacing;
    return std::fmax(0.5 * half, radius - (radius - mean) * (radius - half) / (radius - meanDistance));
  }
  /// The inverse of a sum of moments (addSquare).
  TREACLE_HD static SymmetricBlock<D, float> renormalisationOf(const double* moments) {
    return converted<float>(flooredInverse(squareOf<D>(moments), leastMoment, false));
  }
  /// B_i d
  TREACLE_HD Vec<D> renormalised(std::uint32_t i, const Vec<D>& d) const {
    return accurate ? converted<double>(renormalisation[i]) * d : d;
  }
  /// B'_i d
  TREACLE_HD Vec<D> derivative(std::uint32_t i, const Vec<D>& d) const {
    return accurate ? converted<double>(acrossWalls[i]) * d : d;
  }
  /// e.B_i e with e = d / |d|: by how much the Laplacian of a particle weighs a neighbour at d.
  TREACLE_HD double renormalisedAlong(std::uint32_t i, const Vec<D>& d) const {
    return accurate ? dot(d, renormalised(i, d)) / norm2(d) : 1;
  }
  /// Share of its neighbours that a particle at the free surface misses, by latticeLaplacian.
  TREACLE_HD double missingShare(std::uint32_t i) const { return accurate ? missing[i] : 0; }
  /// Pressure of the gas that particle i would meet at a free surface [Pa].
  TREACLE_HD double outsidePressure(std::uint32_t i) const { return outside ? outside[i] : 0; }
  /// 2/rho of two fluid particles, by their mean density [m3/kg].
  TREACLE_HD double mobilityBetween(std::uint32_t i, std::uint32_t j) const {
    const auto& mobility = this->materials.pairMobility;
    return this->isOneSubstance() ? mobility[0][0] : mobility[this->substance(i)][this->substance(j)];
  }
  /// Harmonic mean of their densities [kg/m3].
  TREACLE_HD double inertiaBetween(std::uint32_t i, std::uint32_t j) const {
    const double a = this->density(i);
    return this->isOneSubstance() ? a : 0.5 * a * this->density(j) * mobilityBetween(i, j);
  }
  /// Coefficient of p_i - p_j in the pressure equation [O23 eq. (11)], with 1/rho of the pair's mean [m/kg].
  TREACLE_HD double pressureCoefficient(std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                                        const Distance& r) const {
    return 0.5 * (renormalisedAlong(i, d) + renormalisedAlong(j, d)) * mobilityBetween(i, j) * slope(r);
  }
  /// That of the difference to what missing neighbours have.
  TREACLE_HD double missingCoefficient(std::uint32_t i) const {
    return missingShare(i) * latticeLaplacian / this->density(i);
  }
  /// Pressure that a fluid particle with pressure p sees in a wall at distance d: the wall holds it against
  /// gravity in the frame of the wall, dp/dn = rho (g - a_wall).n.
  TREACLE_HD double wallPressure(double p, std::uint32_t fluid, std::uint32_t wall, const Vec<D>& d) const {
    const double density = this->density(fluid);
    Vec<D> force = frame.on(this->position[wall], density);
    if (this->wallMotion)
      force -= density * this->wallMotion[this->body[wall]].accelerationAt(this->position[wall]);
    const double held = p + dot(force, d);
    return negativePressure || held > 0 ? held : 0;
  }
};

/// The constants of a case, without particles.
template <int D>
IsphPairs<D> makeIsphPairs(const Case& c);

/// Largest time step [s] at which the explicit viscous step of a case is used: half of what is stable in a full
/// neighbourhood; infinite without viscosity.
template <int D>
double explicitViscousLimit(const IsphPairs<D>& pairs);

/// Half of the diffusivity of momentum [m2/s] with which an explicit viscous step is stable in a full
/// neighbourhood.
template <int D>
double stableDiffusivity(const IsphPairs<D>& pairs) {
  return 0.5 / (pairs.timeStep * pairs.latticeLaplacian);
}

/// Whether a step of dt [s] is implicit in the viscosity; `limit`: explicitViscousLimit.
inline bool isViscousStepImplicit(ViscousStep wanted, double limit, double dt) {
  if (std::isinf(limit)) return false;
  return wanted == ViscousStep::Implicit || (wanted == ViscousStep::Auto && dt > limit);
}

}  // namespace treacle
