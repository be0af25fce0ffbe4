#pragma once

#include "treacle/core/macros.hpp"

namespace treacle {

/// A particle in a step, which resists a pressure that acts on one side of it alone.
struct PressedParticle {
  static constexpr double latticeViscosity = 2.5;  // l^2/mu times the mean diagonal of V in a lattice: 2.2 to 2.6

  double density;    // rho [kg/m3]
  double viscosity;  // mu [Pa s]
  double spacing;    // l [m]
  double timeStep;   // dt [s]

  /// R = rho l^2 / dt + 2.5 mu [Pa s]: inertia resists like a viscosity.
  TREACLE_HD double resistance() const {
    return density * spacing * spacing / timeStep + latticeViscosity * viscosity;
  }
  /// How far the pressure p [Pa] carries the particle, in spacings.
  TREACLE_HD double way(double p) const { return p * timeStep / resistance(); }
};

/// Bounds of the additional viscosity by which long steps keep particles under pressure in their places
/// (docs/accurate.md).
struct StiffnessLimits {
  double most;  // way of a particle, in spacings, up to which it needs no such viscosity
  double kept;  // what the viscosity leaves of longer ways

  /// Measured (docs/notes/trouble.md). `pressureRadius`: h_p in spacings.
  static StiffnessLimits of(double pressureRadius);

  /// That of a particle under the pressure p [Pa]; zero in a fluid without viscosity [Pa s].
  TREACLE_HD double viscosity(const PressedParticle& particle, double p) const {
    // From half of the limit on, so that a pressure that grows does not switch it.
    const double share = 2 * particle.way(p) / most - 1;
    if (!(share > 0 && particle.viscosity > 0)) return 0;
    return (share < 1 ? share : 1) * p * particle.timeStep / (PressedParticle::latticeViscosity * kept);
  }
};

}  // namespace treacle
