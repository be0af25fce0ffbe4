#pragma once

#include "treacle/core/vec.hpp"

#include <cstddef>
#include <string>
#include <vector>

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
  double smagorinsky = 0;         // C of the eddy viscosity rho (C l)^2 |S|, with the law of the wall; 0: laminar
  double shifting = 0;            // coefficient of particle shifting, 0: off
  bool negativePressure = false;  // false: negative pressures are cut to zero

  bool operator==(const IsphSettings&) const = default;
};

/// The formulas of a method. Published: those of its paper. Accurate: formulas that converge under refinement
/// (docs/accurate.md). For MPH-I the scheme decides on
/// - the weights of divergences and pressure gradients, (1-q)^2 or a folded window, with q = r/h,
/// - the weight of the viscosity of a pair, (1-q)/q^3 or (1-q)^2/q,
/// - the velocity that the fluid meets in a wall: that of each wall particle, or the wall's velocity extrapolated
///   through its surface,
/// - the pressure gradient: the plain sum over neighbours, or a renormalised one whose transpose, the divergence,
///   is exact for velocities that are linear in space, also at free surfaces,
/// and on the radii that a case does not give (defaultMethod). For ISPH it decides between the sums of [O23] and
/// those of docs/isph.md.
enum class SchemeKind { Accurate, Published };

/// Of MPH-I, the accurate scheme's.
struct MethodSettings {
  MethodKind kind = MethodKind::MphI;
  SchemeKind scheme = SchemeKind::Accurate;
  // Effective radii in particle spacings.
  double pressureRadius = 2.5;   // h_p / l
  double densityRadius = 3.5;    // h_n / l, at least that of the pressure
  double viscosityRadius = 3.5;  // h_v / l
  // Which share of the viscosity that its missing neighbours would give it a particle gets from those it has.
  double viscosityCorrection = 0.5;
  double tensionLimit = 0;        // the fluid parts where its tension is more; 0: it bears any [Pa]
  double backgroundPressure = 0;  // of fluid of its own density [Pa]
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

inline constexpr std::size_t maxVents = 64;  // of a case
/// Where trapped gas gets out: a box that counts as open air as far as no fluid and no wall fills it.
struct Vent {
  std::string name;
  Vec<3> min{}, max{};  // [m]

  bool operator==(const Vent&) const = default;
};

/// Gas that the fluid traps (docs/gas.md).
struct GasSettings {
  double pressure = 101325;  // of the air around the fluid [Pa]
  double exponent = 1;       // k of p V^k = const in a pocket
  std::vector<Vent> vents{};

  bool operator==(const GasSettings&) const = default;
};

}  // namespace treacle
