#pragma once

namespace treacle {

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

}  // namespace treacle
