#pragma once

namespace treacle {

enum class MethodKind { MphI, Isph };
enum class KernelKind { CubicSpline, WendlandC2 };
enum class WallSlip { NoSlip, FreeSlip };
enum class ViscousStep { Auto, Explicit, Implicit };

/// Incompressible SPH by projection [O23]; docs/isph.md.
struct IsphSettings {
  KernelKind kernel = KernelKind::CubicSpline;
  double smoothingRatio = 1.2;  // h / l; both kernels reach 2 h
  double alpha = 0.01;          // share of the density error that a step is to correct [O23 eq. (10)]
  WallSlip walls = WallSlip::NoSlip;
  ViscousStep viscosity = ViscousStep::Auto;  // Auto: implicit where the explicit step would be unstable
  double shifting = 0;                        // coefficient of particle shifting, 0: off
  bool negativePressure = false;              // false: negative pressures are cut to zero

  bool operator==(const IsphSettings&) const = default;
};

/// Of MPH-I: weights and radii that go together; what a case does not say itself is its scheme's (defaultMethod).
/// Accurate converges under refinement; Published is that of [K23].
enum class SchemeKind { Accurate, Published };
/// Weight of densities, divergences and pressure gradients, and weight of the viscosity, with q = r/h: those of
/// [K23], (1-q)^2 and what its derivative makes of the viscosity, (1-q)/q^3; Wendland's functions C2,
/// (1-q)^4 (1+4q), and C4, (1-q)^6 (3+18q+35q^2); (1-q^2)^2/q^2, and (1-q)^2/q.
enum class PressureWeight { Mps, WendlandC2, WendlandC4 };
enum class ViscosityWeight { Mps, Biquadratic, Quadratic };
/// Which velocity the fluid meets in a wall: each wall particle's own, so that a wall ends somewhere between its
/// first particles and the fluid, or the wall's velocity extrapolated through its surface, which is then where it
/// ends.
enum class WallVelocity { Own, Extrapolated };
/// Which gradient the pressure has: the plain sum over neighbours, or one whose transpose, the divergence, is
/// exact for velocities that are linear in space, at free surfaces, too.
enum class PressureGradient { Plain, Renormalised };

/// Of MPH-I, the accurate scheme's.
struct MethodSettings {
  MethodKind kind = MethodKind::MphI;
  SchemeKind scheme = SchemeKind::Accurate;
  PressureWeight pressureWeight = PressureWeight::WendlandC2;
  ViscosityWeight viscosityWeight = ViscosityWeight::Quadratic;
  WallVelocity wallVelocity = WallVelocity::Extrapolated;
  PressureGradient pressureGradient = PressureGradient::Renormalised;
  // Effective radii in particle spacings.
  double pressureRadius = 2.5;   // h_p / l
  double densityRadius = 3.5;    // h_n / l, at least that of the pressure
  double viscosityRadius = 3.5;  // h_v / l
  // Which share of the viscosity that its missing neighbours would give it a particle gets from those it has.
  double viscosityCorrection = 0.5;
  double ambientPressure = 101325;  // around the fluid; it parts where its own is less than minus that [Pa]
  IsphSettings isph;

  bool operator==(const MethodSettings&) const = default;
};

/// How the viscosity of fluids with a rheology and the flow of a step are brought together.
struct RheologySettings {
  int iterations = 10;      // largest number of solves in a step
  double tolerance = 0.03;  // change of the viscosity, in mean over the dissipation, that no further solve follows

  bool operator==(const RheologySettings&) const = default;
};

/// Temperatures of the fluid (docs/heat.md).
struct HeatSettings {
  double ambient = 293.15;     // temperature around the fluid [K]
  double transfer = 0;         // from free surfaces to there [W/(m2 K)]
  bool viscousHeating = true;  // what the viscosity takes from the motion is heat
  double tolerance = 1e-12;    // of the solve of a step: bound on |r|^2 / |b|^2
  int maxIterations = 1000;

  bool operator==(const HeatSettings&) const = default;
};

}  // namespace treacle
