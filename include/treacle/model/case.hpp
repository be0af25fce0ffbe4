#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/rheology.hpp"
#include "treacle/model/viscosity_shift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// The data of one simulation: SI units, resolution already applied. Two-dimensional cases leave the third
/// component at zero. A case read from a file is checked; for one made in code requireValid says what is wrong
/// with it.

struct Material {
  std::string name;
  double density = 0;           // rho [kg/m3]
  double dynamicViscosity = 0;  // mu, without a rheology [Pa s]
  double bulkViscosity = 0;     // lambda [Pa s]
  double bulkModulus = 0;       // kappa [Pa]
  double slipLength = 0;        // how far behind a wall its velocity, extrapolated, is the wall's [m]; 0: no slip
  double surfaceTension = 0;    // gamma of its free surface [N/m]; MPH-I only
  double contactAngle = 90;     // of a wall, with free surfaces of all fluids [deg]
  std::optional<Rheology> rheology{};  // of a fluid that is not Newtonian; MPH-I only
  // In cases with heat.
  double specificHeat = 0;                         // c_p [J/(kg K)]
  double conductivity = 0;                         // k [W/(m K)]
  double emissivity = 0;                           // of the free surface [-]
  std::optional<ViscosityShift> viscosityShift{};  // missing: the viscosity does not follow the temperature

  /// mu at a shear rate [1/s], where a_T is `shift` [Pa s].
  double viscosity(double rate, double shift) const {
    return rheology ? rheology->viscosity(rate, shift) : shift * dynamicViscosity;
  }
  /// Whether its viscosity is not one number.
  bool hasOwnViscosities() const { return rheology.has_value() || viscosityShift.has_value(); }

  bool operator==(const Material&) const = default;
};

/// Largest number of materials of one case: pair sums look their constants up in small tables.
inline constexpr std::size_t maxMaterials = 16;

/// Largest number of bodies: particles keep theirs in one byte, of which one value says that it is not known.
inline constexpr std::size_t maxBodies = 255;

enum class ShapeKind { Box, Sphere, Cylinder };

/// A region of space. In two dimensions a sphere is a disc and a cylinder a strip along its axis.
struct Shape {
  ShapeKind kind = ShapeKind::Box;
  Vec<3> min{}, max{};     // box corners [m]
  Vec<3> center{};         // sphere [m]
  Vec<3> start{}, end{};   // cylinder: ends of the axis [m]
  double radius = 0;       // sphere, cylinder [m]
  double innerRadius = 0;  // sphere, cylinder: hollow inside [m]

  bool operator==(const Shape&) const = default;
};

enum class BodyKind { Fluid, Wall };

/// Displacement of a wall from where it starts: amplitude (sin(2 pi t / period + phase) - sin(phase)).
struct Oscillation {
  Vec<3> amplitude{};  // [m]
  double period = 0;   // [s]; 0: none
  double phase = 0;    // [rad]

  bool operator==(const Oscillation&) const = default;
};

/// Rotation of a wall, counter-clockwise seen from the end of its axis. The centre goes along with the wall's
/// translation and oscillation.
struct Rotation {
  Vec<3> center{};       // at the start [m]
  Vec<3> axis{0, 0, 1};  // of any length but zero; in two dimensions this one
  double speed = 0;      // [rad/s]

  Vec<3> direction() const { return axis * (1 / norm(axis)); }

  bool operator==(const Rotation&) const = default;
};

/// Particles of one kind and material that fill a shape. Expressions are those of model/expression.hpp; an empty
/// one is none.
struct Body {
  std::string name;
  BodyKind kind = BodyKind::Fluid;
  int material = 0;   // index into Case::materials
  Vec<3> velocity{};  // fluid: at the start; wall: prescribed translation [m/s]
  Shape shape;
  Oscillation oscillation{};                        // of a wall, on top of its velocity
  std::optional<Rotation> rotation{};               // of a wall, on top of both
  std::array<std::string, 3> velocityExpression{};  // of a fluid, in place of a component of its velocity [m/s]
  std::string where{};                              // there are particles only where it is not zero
  // In cases with heat. Of a fluid that at the start; of a wall that of its surface or, where it has a
  // conductance, of what is behind it; 0: the wall is adiabatic [K].
  double temperature = 0;
  std::string temperatureExpression{};  // of a fluid, in place of its temperature [K]
  double wallConductance = 0;           // of a wall, its conductivity over its thickness [W/(m2 K)]; 0: infinite

  bool operator==(const Body&) const = default;
};

struct Domain {
  Vec<3> min{}, max{};             // [m]
  std::array<bool, 3> periodic{};  // false: open, a particle that leaves ends the run

  bool operator==(const Domain&) const = default;
};

struct TimeSettings {
  double step = 0;     // [s]; where steps vary the longest one
  double end = 0;      // [s]
  double courant = 0;  // distance of the fastest particle in a step, in spacings; 0: no bound by the case
  // Steps of MPH-I that are chosen by their errors (docs/time-step.md).
  bool automatic = false;
  double tolerance = 0.02;  // of the error of a step
  double least = 0;         // shortest step [s]

  bool stepsVary() const { return courant > 0 || automatic; }
  /// The key that bounds the steps.
  const char* stepKey() const { return automatic ? "time.max_step" : "time.step"; }
  /// The bound on that distance that holds; 0: none.
  double mostCourant() const { return courant > 0 || !automatic ? courant : 1; }

  bool operator==(const TimeSettings&) const = default;
};

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
  double densityRadius = 3;      // h_n / l, at least that of the pressure
  double viscosityRadius = 3.5;  // h_v / l
  // Which share of the viscosity that its missing neighbours would give it a particle gets from those it has.
  double viscosityCorrection = 0.5;
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

enum class KrylovKind { Cg, Cr };
/// For MPH-I all but the last two; for ISPH none, Jacobi and the last two.
enum class PreconditionerKind {
  None,
  Jacobi,
  BlockJacobi,
  BucketMultigrid,
  ProjectedMultigrid,
  CellMultigrid,
  HatMultigrid
};
enum class OperatorKind { MatrixFree, Assembled };
enum class Precision { Double, Mixed };
enum class SmootherDiagonal { Jacobi, ExtendedJacobi };
enum class NeighbourKind { Lists, Ranges };
enum class CoarseKind { Auto, Direct, Spgemm };
enum class FirstGuess { Last, Linear, Quadratic };

/// Bucket multigrid [K23 sect. 3.2]. The defaults are those of the authors' program; the paper as printed
/// has 2, 2, 4 and the extended Jacobi diagonal on the particles.
struct MultigridSettings {
  int finestSweeps = 2;    // pre and post sweeps each, level 0
  int middleSweeps = 3;    // pre and post sweeps each, levels between
  int coarsestSweeps = 4;  // sweeps on the last level
  SmootherDiagonal particleDiagonal = SmootherDiagonal::Jacobi;
  /// On a GPU: coarse operators from sums of pair terms, or as products of sparse matrices.
  CoarseKind coarseOperators = CoarseKind::Auto;

  bool operator==(const MultigridSettings&) const = default;
};

/// Projected multigrid (docs/solver.md). Degrees are those of its smoothers; 0: chosen by the program.
struct ProjectedSettings {
  int pressureDegree = 0;    // of the pressures on the particles
  int gridDegree = 0;        // of the pressures on the background grids
  int velocityDegree = 0;    // of the velocities on the particles
  int iterationBound = 100;  // a solve that needs more is tried in other ways

  bool operator==(const ProjectedSettings&) const = default;
};

/// Background-cell multigrid of ISPH, MGCG(m, n) of [O23 sect. 3.2].
struct CellSettings {
  int levels = 0;  // m; 0: down to the coarsest cells
  int sweeps = 4;  // n, before and after each coarse correction

  bool operator==(const CellSettings&) const = default;
};

/// Hat-function multigrid of ISPH (docs/isph.md).
struct HatSettings {
  int gridDegree = 0;        // of the smoothers on its grids; 0: chosen by the program
  int iterationBound = 100;  // a solve that needs more is tried in other ways

  bool operator==(const HatSettings&) const = default;
};

/// Largest number of modes that a solve can be deflated by.
inline constexpr int maxModes = 16;

struct SolverSettings {
  // The defaults are those of MPH-I; defaultSolver has others for ISPH and for other preconditioners.
  KrylovKind krylov = KrylovKind::Cg;
  PreconditionerKind preconditioner = PreconditionerKind::ProjectedMultigrid;
  OperatorKind operatorKind = OperatorKind::MatrixFree;
  NeighbourKind neighbours = NeighbourKind::Lists;  // on a GPU; ranges: no memory for lists, more time
  double tolerance = 1e-12;                         // bound on |r|^2 / |b|^2
  int maxIterations = 5000;
  /// Mixed: the preconditioner works in single precision.
  Precision precision = Precision::Mixed;
  /// A solve starts from the velocities of the last step, or from those of two or three extrapolated. ISPH: from
  /// the pressures of the last step.
  FirstGuess firstGuess = FirstGuess::Quadratic;
  /// Largest number of modes that conjugate gradients with the projected multigrid are deflated by; 0: none.
  int deflation = 8;
  /// Where processes share the case: grids of the preconditioner with more nodes than that are divided between
  /// them like the particles, smaller ones stand whole at every process. A product with a grid of so many takes
  /// about as long as the exchange that comes before it where it is divided.
  int dividedNodes = 100000;
  MultigridSettings multigrid;
  ProjectedSettings projected;
  CellSettings cells;
  HatSettings hats;

  /// Whether solves are deflated by modes: where `deflation` means anything.
  bool deflates() const {
    return deflation > 0 && krylov == KrylovKind::Cg && preconditioner == PreconditionerKind::ProjectedMultigrid;
  }

  bool operator==(const SolverSettings&) const = default;
};

struct OutputFields {
  bool velocity = true, pressure = true, numberDensity = true, nearestDistance = true, material = true,
       body = true, id = true;
  bool dynamicViscosity = true, shearRate = true;  // in cases where a material has a rheology
  bool temperature = true;                         // in cases with heat

  bool operator==(const OutputFields&) const = default;
};

enum class OutputFormat { Vtp };  // the only one
enum class OutputPrecision { Single, Double };
/// Who writes frames where processes share a run: the first one all particles, or each its own.
enum class OutputPieces { Auto, One, Each };

struct OutputSettings {
  double interval = 0;            // between frames [s]; 0: first and last frame only
  double checkpointInterval = 0;  // between checkpoints [s]; 0: at the end of the run only
  OutputFields fields;
  OutputPrecision precision = OutputPrecision::Single;
  OutputPieces pieces = OutputPieces::Auto;
  bool balance = false;  // energy balance and loads on walls of each step; MPH-I only

  bool operator==(const OutputSettings&) const = default;
};

/// Beyond which a run ends, because it no longer means anything; 0: is not looked at. step/watch.hpp says what is
/// measured. Warnings come earlier.
struct WatchSettings {
  double energy = 1;          // rise of the mechanical energy over what start and gravity have given
  double courant = 10;        // distance of the fastest particle in a step, in spacings
  double insideWalls = 0.05;  // share of fluid particles inside walls
  double density = 0.25;      // mean excess of the density over that of the material

  bool operator==(const WatchSettings&) const = default;
};

struct Case {
  std::string title;
  int dimensions = 2;
  double spacing = 0;     // l [m], resolution applied
  double resolution = 1;  // what spacing and time step were divided by
  Domain domain;
  Vec<3> gravity{};  // [m/s2]
  std::vector<Material> materials;
  std::vector<Body> bodies;
  TimeSettings time;
  MethodSettings method;
  RheologySettings rheology;
  std::optional<HeatSettings> heat{};  // missing: there are no temperatures; MPH-I only
  SolverSettings solver;
  OutputSettings output;
  WatchSettings watch;

  double pressureRadius() const { return method.pressureRadius * spacing; }  // h_p [m]
  /// h_n [m]
  double densityRadius() const { return std::max(method.densityRadius, method.pressureRadius) * spacing; }
  double viscosityRadius() const { return method.viscosityRadius * spacing; }  // h_v [m]
  /// r_0: distance below which particles of the accurate scheme of MPH-I repel each other; 0: they do not [m].
  double repulsionRadius() const { return method.scheme == SchemeKind::Accurate ? 0.53 * spacing : 0; }
  /// Smoothing length h of ISPH [m].
  double smoothingLength() const { return method.isph.smoothingRatio * spacing; }
  /// Farthest distance at which particles act on each other [m].
  double interactionRadius() const {
    return method.kind == MethodKind::Isph ? 2 * smoothingLength() : std::max(viscosityRadius(), densityRadius());
  }
  /// Smallest edge of the search cells [m].
  double searchEdge() const {
    return method.kind == MethodKind::Isph ? 2 * smoothingLength()
                                           : std::max({viscosityRadius(), densityRadius(), 2 * pressureRadius()});
  }
  /// Whether particles have viscosities of their own, by their shear rates or temperatures: they then have the
  /// former, too.
  bool hasOwnViscosities() const {
    return std::ranges::any_of(materials, [](const Material& m) { return m.hasOwnViscosities(); });
  }
  /// The temperature that the first fluid of a material of the case starts with; where a formula says that, one
  /// that the material has its constants at [K]. And a_T there.
  double typicalTemperature(const Material& m) const;
  double typicalShift(const Material& m) const;
  /// mu there, of a rheology that at a shear rate of 1/s: for what needs one number that stands for all [Pa s].
  double typicalViscosity(const Material& m) const { return m.viscosity(1, typicalShift(m)); }
  /// Whether materials differ among the fluids: those of fluid bodies, or all where no body says which.
  bool hasSeveralFluids() const {
    const auto isFluid = [](const Body& body) { return body.kind == BodyKind::Fluid; };
    const auto first = std::ranges::find_if(bodies, isFluid);
    if (first == bodies.end()) return materials.size() > 1;
    return std::ranges::any_of(
        bodies, [&](const Body& body) { return isFluid(body) && body.material != first->material; });
  }
  bool hasSurfaceTension() const {
    return std::ranges::any_of(materials, [](const Material& m) { return m.surfaceTension > 0; });
  }
  /// Steps to the end, where all have one length.
  std::int64_t steps() const { return std::llround(time.end / time.step); }
  /// Whether a run that has made so many steps, and is at time `now` [s], is at its end.
  bool atEnd(std::int64_t step, double now) const {
    return time.stepsVary() ? now >= time.end * (1 - 1e-9) : step >= steps();
  }

  bool operator==(const Case&) const = default;
};

}  // namespace treacle
