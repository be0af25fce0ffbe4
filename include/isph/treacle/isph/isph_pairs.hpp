#pragma once

#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/particles/smoothing_kernel.hpp"
#include "treacle/search/material_particles.hpp"
#include "treacle/search/neighbour_rows.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// A particle is at the free surface where it has few neighbours, or where they stand on one side of it: its
/// density is below `sparse` of that of a full lattice, or below `dense` with a lack of neighbours |sum V grad W|
/// above `oneSided`, in units of 1/l. The first catches spray and threads, the second sheets and surfaces, and not
/// the hollows that open for a few steps inside a splashing body. Single particles jammed into walls have no
/// equation to take a pressure from: with less than fewest() fluid neighbours (a corner has 7 in 2D and 16 in 3D)
/// they count, too.
struct SurfaceCriterion {
  double sparse = 0.75, dense = 1.05, oneSided = 0.2;
  TREACLE_HD static constexpr int fewest(int dimensions) { return dimensions == 2 ? 4 : 8; }
};

/// Shares of a particle's density that walls make up.
struct WallContact {
  double touching = 0;    // with a flat wall whose first layer is one spacing away
  double pressed = 0.35;  // 0.3 spacings nearer
  double inside = 0.6;    // on the first layer; three walls that meet come to 0.5
};

/// What the sums of ISPH read: sorted particles, their neighbours and the constants of the case.
template <int D>
struct IsphPairs : MaterialParticles<D> {
  NeighbourRowsView fluidOfFluid;  // FluidOfFluid
  std::uint64_t fluidEntries = 0;  // of these rows
  NeighbourRowsView wallsOfFluid;  // WallsOfFluid
  NeighbourRowsView fluidOfWalls;  // FluidOfWalls
  const std::uint8_t* body = nullptr;
  const WallMotion<D>* wallMotion = nullptr;  // per body; none: no wall accelerates
  SmoothingKernel<D> kernel{};
  SurfaceCriterion surface;
  Vec<D> gravity{};                            // [m/s2]
  double volume = 0;                           // of a particle, l^D [m^D]
  double latticeDensity = 0;                   // sum of V W over a full lattice [-]
  double leastDensity = 0, mostViscosity = 0;  // of fluids [kg/m3], [Pa s]
  double mostDiffusivity = 0;                  // of their momentum, next to walls, too [m2/s]
  WallContact contact;
  double timeStep = 0;            // [s]
  double alpha = 0;               // [-]
  bool noSlip = true;             // walls hold the fluid by its viscosity
  bool negativePressure = false;  // or cut to zero

  /// V |W'| / r [1/m2]: V grad_i W = slope (x_j - x_i).
  TREACLE_HD double slope(const Distance& r) const { return volume * kernel.slope(r); }
  /// Coefficient of p_i - p_j in the pressure equation [O23 eq. (11)], with 1/rho of the pair's mean [m/kg].
  TREACLE_HD double pressureCoefficient(const Distance& r, Substance a, Substance b) const {
    return this->materials.pairMobility[a][b] * slope(r);
  }
  /// Pressure that a fluid particle with pressure p sees in a wall at distance d: the wall holds it against
  /// gravity in the frame of the wall, dp/dn = rho (g - a_wall).n.
  TREACLE_HD double wallPressure(double p, std::uint32_t fluid, std::uint32_t wall, const Vec<D>& d) const {
    Vec<D> g = gravity;
    if (wallMotion) g -= wallMotion[body[wall]].accelerationAt(this->position[wall]);
    const double outside = p + this->density(fluid) * dot(g, d);
    return negativePressure || outside > 0 ? outside : 0;
  }
};

/// The constants of a case, without particles.
template <int D>
IsphPairs<D> makeIsphPairs(const Case& c);

/// Largest time step [s] at which the explicit viscous step of a case is used: half of what is stable in a full
/// neighbourhood; infinite without viscosity.
template <int D>
double explicitViscousLimit(const IsphPairs<D>& pairs);

/// Whether a step of dt [s] is implicit in the viscosity; `limit`: explicitViscousLimit.
inline bool isViscousStepImplicit(ViscousStep wanted, double limit, double dt) {
  if (std::isinf(limit)) return false;
  return wanted == ViscousStep::Implicit || (wanted == ViscousStep::Auto && dt > limit);
}

}  // namespace treacle
