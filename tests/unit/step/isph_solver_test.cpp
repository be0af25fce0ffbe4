#include "method/isph_solver.hpp"

#include "support/isph_cases.hpp"
#include "support/matrices.hpp"
#include "support/pressure_column.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// The jittered columns of the study (PressureColumn) as particles of ISPH: spacing 1, p = 0 on the top and front
/// layers, no walls.
struct Column {
  static Case columnCase(Vec<3, int> size) {
    Case c = waterCase(3, {});
    c.method.scheme = SchemeKind::Published;
    c.spacing = 1;
    c.materials[0].density = 1;
    c.time.step = 1;
    for (int k = 0; k < 3; ++k) {
      c.domain.min[k] = -0.37;
      c.domain.max[k] = c.domain.min[k] + 2.4 * std::ceil((size[k] + 0.37) / 2.4);  // whole cells of the kernel
    }
    return c;
  }
  static Particles<3> points(Vec<3, int> size) {
    std::vector<Vec<3>> x;
    for (int i = 0; i < size[0] * size[1] * size[2]; ++i) {
      Vec<3> at{double(i / (size[1] * size[2])), double(i / size[2] % size[1]), double(i % size[2])};
      for (int k = 0; k < 3; ++k) at[k] += 0.15 * pseudoRandom(3 * i + k);
      x.push_back(at);
    }
    return particlesAt<3>(x);
  }

  Vec<3, int> size;
  IsphScene<3> s;
  std::vector<double> b;

  explicit Column(Vec<3, int> theSize) : size(theSize), s(columnCase(size), points(size)), b(s.n()) {
    for (std::uint32_t i = 0; i < s.n(); ++i) {
      const auto id = static_cast<int>(s.particles.id[i]);
      const bool isOuter = id % size[2] == size[2] - 1 || id / (size[1] * size[2]) == size[0] - 1;
      s.surface[i] = isOuter ? Place::Free : Place::Inside;
      b[i] = isOuter ? 0 : pseudoRandom(s.particles.id[i]);
    }
  }

  struct Solved {
    std::vector<double> x;
    StagedReport report;
    std::size_t bytes = 0;  // of the solver
  };

  /// From zero, to a relative residual of 1e-6 unless told.
  Solved solve(PreconditionerKind kind, Precision precision, double tolerance = 1e-12) {
    s.c.solver.preconditioner = kind;
    s.c.solver.precision = precision;
    s.c.solver.tolerance = tolerance;
    IsphSolver<3, Cpu, PressureRow<3>> solver(solveStages(s.c));
    solver.prepareMatrix(s.context, s.pairs, s.ranges, PressureRow<3>{s.surface.data()});
    solver.preparePreconditioner(s.context);
    Solved solved;
    solved.x.resize(s.n());
    solved.report = solver.solve(s.context, b, solved.x);
    solved.bytes = solver.bytes();
    EXPECT_EQ(solved.report.status, SolveStatus::Converged);
    EXPECT_EQ(solved.report.fallbacks, 0) << solved.report.failures;
    EXPECT_EQ(solved.report.startResidual, 1);
    EXPECT_LE(solved.report.residual, tolerance);
    for (std::uint32_t i = 0; i < s.n(); ++i) EXPECT_TRUE(!s.surface[i] || solved.x[i] == 0);
    // The residual that is reported is the true one, of the matrix as it is stored.
    EXPECT_NEAR(trueResidual(solved.x), std::sqrt(solved.report.residual),
                precision == Precision::Double ? 1e-10 : 5e-9);
    return solved;
  }
  int iterations(PreconditionerKind kind, Precision precision) { return solve(kind, precision).report.iterations; }

  double trueResidual(const std::vector<double>& x) {
    const IsphTestSystem<3, double> system(s, PressureRow<3>{s.surface.data()});
    std::vector<double> y(s.n());
    multiply<double>(s.context, system.a, x, y);
    return relativeDifference<double>(y, b);
  }

  /// The matrix with ones where the pressure is known to be zero.
  Matrix denseMatrix() {
    const IsphTestSystem<3, double> system(s, PressureRow<3>{s.surface.data()});
    Matrix a = dense(system.a);
    for (std::uint32_t i = 0; i < s.n(); ++i)
      if (s.surface[i]) a(i, i) = 1;
    return a;
  }
};

TEST(IsphSolver, ComesNearerToTheDirectSolutionWithEveryIteration) {
  Column column({9, 8, 7});
  const Matrix a = column.denseMatrix();
  const Vector exact = solve(a, Vector(column.b));
  const double scale = std::sqrt(exact.dot(a * exact));
  using enum PreconditionerKind;
  for (const PreconditionerKind kind : {None, Jacobi, CellMultigrid, HatMultigrid})
    for (const KrylovKind krylov : {KrylovKind::Cg, KrylovKind::Cr}) {
      SCOPED_TRACE(testing::Message() << "preconditioner " << static_cast<int>(kind) << ", krylov "
                                      << static_cast<int>(krylov));
      column.s.c.solver.krylov = krylov;
      int before = 0;
      double last = 1;
      for (const double tolerance : {1e-4, 1e-12, 1e-24}) {
        const Column::Solved solved = column.solve(kind, Precision::Double, tolerance);
        const Vector error = Vector(solved.x) - exact;
        const double energy = std::sqrt(error.dot(a * error)) / scale;
        EXPECT_GT(solved.report.iterations, before);
        EXPECT_LT(energy, last);
        EXPECT_LT(energy, 10 * std::sqrt(tolerance));
        before = solved.report.iterations, last = energy;
      }
    }
}

TEST(IsphSolver, CountsTheMemoryOfItsMatrixAndVectors) {
  Column column({9, 9, 9});
  const std::size_t n = column.s.n(), entries = column.s.pairs.fluidEntries;
  const auto bytes = [&](PreconditionerKind kind, Precision precision) {
    return column.solve(kind, precision).bytes;
  };
  using enum PreconditionerKind;
  // Coefficients, the diagonal and its inverse of near pairs, moments, and of CG at least r, p and A p.
  const std::size_t rows = sizeof(double) + sizeof(IsphMoments<3>) + 3 * sizeof(double);
  EXPECT_GE(bytes(None, Precision::Double), entries * sizeof(double) + n * (rows + sizeof(double)));
  EXPECT_GE(bytes(None, Precision::Mixed), entries * sizeof(float) + n * (rows + sizeof(float)));
  EXPECT_EQ(bytes(None, Precision::Double) - bytes(None, Precision::Mixed), (entries + n) * sizeof(float));
  // The cells' matrix is made of a copy of that of the unknowns, with its columns.
  std::size_t unknown = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    column.s.pairs.fluidOfFluid.forEachPlace(i, [&](std::uint64_t k) {
      unknown += !column.s.surface[i] && !column.s.surface[column.s.pairs.fluidOfFluid.column[k]];
    });
  EXPECT_GE(bytes(CellMultigrid, Precision::Mixed),
            bytes(None, Precision::Mixed) + unknown * (sizeof(double) + sizeof(std::uint32_t)));
  EXPECT_GE(bytes(HatMultigrid, Precision::Mixed), bytes(None, Precision::Mixed) + 2 * n * sizeof(float));
}

TEST(IsphSolver, HasTheMatrixOfTheStudy) {
  const Vec<3, int> size{9, 8, 7};
  Column column(size);
  const IsphTestSystem<3, double> system(column.s, PressureRow<3>{column.s.surface.data()});
  const PressureColumn study(size);
  std::vector<std::uint32_t> placeOf(study.count());
  for (std::uint32_t i = 0; i < study.count(); ++i) placeOf[study.latticeOf[i]] = i;
  const Matrix expected = dense(study.a), found = dense(system.a);
  for (std::uint32_t i = 0; i < column.s.n(); ++i)
    for (std::uint32_t j = 0; j < column.s.n(); ++j)
      ASSERT_NEAR(found(i, j), expected(placeOf[column.s.particles.id[i]], placeOf[column.s.particles.id[j]]),
                  1e-13);
}

TEST(IsphSolver, DefaultIsFlatInTheSizeOfTheColumnAndPlainIterationsGrow) {
  using enum PreconditionerKind;
  struct Study {
    Vec<3, int> size;
    int cg, cells;  // by the study's own program, which numbers cells from another corner
  };
  for (const Study& study : {Study{{9, 9, 9}, 35, 20},
                             {{17, 9, 9}, 43, 21},
                             {{17, 17, 17}, 59, 23},
                             {{31, 17, 17}, 78, 24},
                             {{31, 31, 31}, 105, 27}}) {
    SCOPED_TRACE(testing::Message() << study.size[0] << " x " << study.size[1] << " x " << study.size[2]);
    Column column(study.size);
    EXPECT_NEAR(column.iterations(None, Precision::Double), study.cg, 1);
    EXPECT_NEAR(column.iterations(Jacobi, Precision::Double), study.cg, 0.15 * study.cg);
    EXPECT_NEAR(column.iterations(CellMultigrid, Precision::Double), study.cells, 2);
    const int hats = column.iterations(HatMultigrid, Precision::Mixed);
    EXPECT_LE(hats, 7);
    EXPECT_GE(hats, 5);
    EXPECT_NEAR(column.iterations(HatMultigrid, Precision::Double), hats, 1);
  }
}

TEST(IsphSolver, ConjugateResidualsTakeAsManyIterations) {
  Column column({9, 9, 9});
  for (const PreconditionerKind kind :
       {PreconditionerKind::Jacobi, PreconditionerKind::CellMultigrid, PreconditionerKind::HatMultigrid})
    for (const Precision precision : {Precision::Double, Precision::Mixed}) {
      column.s.c.solver.krylov = KrylovKind::Cg;
      const int cg = column.iterations(kind, precision);
      column.s.c.solver.krylov = KrylovKind::Cr;
      const int cr = column.iterations(kind, precision);
      EXPECT_LE(cr, cg + 2);
      EXPECT_GE(cr, cg - 4);
    }
}

}  // namespace
}  // namespace treacle::test
