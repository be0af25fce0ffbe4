#pragma once

#include "treacle/core/vec.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// The data of one simulation after reading and checking: SI units, resolution already applied.
/// Two-dimensional cases leave the third component at zero.

struct Material {
  std::string name;
  double density = 0;           // rho [kg/m3]
  double dynamicViscosity = 0;  // mu [Pa s]
  double bulkViscosity = 0;     // lambda [Pa s]
  double bulkModulus = 0;       // kappa [Pa]

  bool operator==(const Material&) const = default;
};

/// Largest number of materials of one case: pair sums look their constants up in small tables.
inline constexpr std::size_t maxMaterials = 16;

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

/// Particles of one kind and material that fill a shape.
struct Body {
  std::string name;
  BodyKind kind = BodyKind::Fluid;
  int material = 0;   // index into Case::materials
  Vec<3> velocity{};  // fluid: at the start; wall: prescribed translation [m/s]
  Shape shape;

  bool operator==(const Body&) const = default;
};

struct Domain {
  Vec<3> min{}, max{};             // [m]
  std::array<bool, 3> periodic{};  // false: open, a particle that leaves ends the run

  bool operator==(const Domain&) const = default;
};

struct TimeSettings {
  double step = 0;  // [s]
  double end = 0;   // [s]

  bool operator==(const TimeSettings&) const = default;
};

/// Effective radii in particle spacings [K23 Table 1].
struct MethodSettings {
  std::string name = "mph-i";
  double pressureRadius = 1.75;  // h_p / l
  double viscosityRadius = 3.5;  // h_v / l

  bool operator==(const MethodSettings&) const = default;
};

enum class KrylovKind { Cg, Cr };
enum class PreconditionerKind { None, Jacobi, BlockJacobi, BucketMultigrid, ProjectedMultigrid };
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

struct SolverSettings {
  KrylovKind krylov = KrylovKind::Cg;  // case files: cr unless the preconditioner is projected-multigrid
  PreconditionerKind preconditioner = PreconditionerKind::ProjectedMultigrid;
  OperatorKind operatorKind = OperatorKind::MatrixFree;
  NeighbourKind neighbours = NeighbourKind::Lists;  // on a GPU; ranges: no memory for lists, more time
  double tolerance = 1e-12;                         // bound on |r|^2 / |b|^2
  int maxIterations = 5000;
  /// Mixed: the preconditioner works in single precision. Case files: double unless it is projected-multigrid.
  Precision precision = Precision::Mixed;
  /// A solve starts from the velocities of the last step, or from those of two or three extrapolated.
  FirstGuess firstGuess = FirstGuess::Quadratic;
  MultigridSettings multigrid;
  ProjectedSettings projected;

  bool operator==(const SolverSettings&) const = default;
};

struct OutputFields {
  bool velocity = true, pressure = true, numberDensity = true, material = true, id = true;

  bool operator==(const OutputFields&) const = default;
};

enum class OutputPrecision { Single, Double };

struct OutputSettings {
  double interval = 0;            // between frames [s]; 0: first and last frame only
  double checkpointInterval = 0;  // between checkpoints [s]; 0: at the end of the run only
  OutputFields fields;
  OutputPrecision precision = OutputPrecision::Single;

  bool operator==(const OutputSettings&) const = default;
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
  SolverSettings solver;
  OutputSettings output;

  double pressureRadius() const { return method.pressureRadius * spacing; }    // h_p [m]
  double viscosityRadius() const { return method.viscosityRadius * spacing; }  // h_v [m]
  std::int64_t steps() const { return std::llround(time.end / time.step); }

  bool operator==(const Case&) const = default;
};

}  // namespace treacle
