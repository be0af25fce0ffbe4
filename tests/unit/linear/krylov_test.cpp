#include "treacle/linear/krylov.hpp"

#include "support/oracle.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

using Flat = std::span<const double>;

/// A real system of the method, its direct solution, and maps for the solvers.
struct System {
  Context<Cpu> context;
  Matrix a;
  Vector b, exact;

  System() {
    Scene<2> s = makeScene<2>();
    a = Oracle<2>(s).matrix();
    b = randomVector(a.rows(), 1);
    exact = treacle::test::solve(a, b);
  }
  auto multiply() const {
    return [this](Flat x, std::span<double> y) {
      const Vector product = a * Vector(x);
      std::copy(product.begin(), product.end(), y.begin());
    };
  }
  auto jacobi() const {
    return [this](Flat r, std::span<double> z) {
      for (std::size_t i = 0; i < r.size(); ++i) z[i] = r[i] / a(i, i);
    };
  }
  template <class Solve, class K>
  SolveReport run(Solve&& solve, const K& k, Vector& x, StoppingRule rule) {
    KrylovWorkspace<> workspace;
    return solve({multiply(), k, Flat(b), std::span<double>(x)}, rule, workspace);
  }
};

const auto cg = [](const LinearSystem& system, const StoppingRule& rule, KrylovWorkspace<>& workspace) {
  static Context<Cpu> context;
  return conjugateGradient(context, system, rule, workspace);
};
const auto cr = [](const LinearSystem& system, const StoppingRule& rule, KrylovWorkspace<>& workspace) {
  static Context<Cpu> context;
  return conjugateResidual(context, system, rule, workspace);
};

TEST(Krylov, AgreesWithTheDirectSolution) {
  System s;
  const auto identity = [](Flat r, std::span<double> z) { std::copy(r.begin(), r.end(), z.begin()); };
  const auto check = [&](auto&& solve, auto&& k) {
    Vector x = s.exact.norm() * randomVector(s.b.size(), 2);
    const SolveReport report = s.run(solve, k, x, {1e-24, 5000});
    EXPECT_EQ(report.status, SolveStatus::Converged);
    EXPECT_GT(report.iterations, 10);
    EXPECT_LT((x - s.exact).norm(), 2e-11 * s.exact.norm());  // measured: 2e-12
    EXPECT_LT((s.b - s.a * x).squaredNorm(), 1e-23 * s.b.squaredNorm());
  };
  check(cg, identity);
  check(cr, identity);
  check(cg, s.jacobi());
  check(cr, s.jacobi());
}

/// Directions in single precision cost no accuracy; of hundreds of iterations they take a third more.
TEST(Krylov, FollowsDirectionsInSinglePrecision) {
  System s;
  int rounded = 0;
  const Product single = [&](Flat p, std::span<double> y) {
    for (const double v : p) ASSERT_EQ(v, static_cast<float>(v));
    s.multiply()(p, y);
    ++rounded;
  };
  const auto solve = [&](const Product* product, Vector& x) {
    KrylovWorkspace<> workspace;
    return conjugateGradient(s.context, {s.multiply(), s.jacobi(), Flat(s.b), std::span<double>(x), product},
                             {1e-16, 5000}, workspace);
  };
  Vector x = Vector::Zero(s.b.size()), y = x;
  const SolveReport report = solve(&single, x), usual = solve(nullptr, y);
  EXPECT_EQ(report.status, SolveStatus::Converged);
  EXPECT_EQ(rounded, report.iterations);
  EXPECT_GT(usual.iterations, 100);
  EXPECT_LE(report.iterations, 1.5 * usual.iterations);  // measured: 1.39
  const double actual = (s.b - s.a * x).squaredNorm() / s.b.squaredNorm();
  EXPECT_NEAR(actual, report.residual, 1e-3 * report.residual);  // measured: 2e-5
}

TEST(Krylov, StopsAtOnceAtTheSolution) {
  System s;
  Vector x = s.exact;
  EXPECT_EQ(s.run(cr, s.jacobi(), x, {1e-12, 100}).iterations, 0);
  EXPECT_EQ(x, s.exact);
}

TEST(Krylov, HasTheResidualItReports) {
  System s;
  for (double tolerance : {1e-4, 1e-8, 1e-12}) {
    Vector x = Vector::Zero(s.b.size());
    const SolveReport report = s.run(cr, s.jacobi(), x, {tolerance, 5000});
    const double actual = (s.b - s.a * x).squaredNorm() / s.b.squaredNorm();
    EXPECT_LE(report.residual, tolerance);
    EXPECT_NEAR(actual, report.residual, 1e-6 * tolerance);
  }
}

TEST(Krylov, LeavesTheHistoryOfItsResiduals) {
  System s;
  const auto check = [&](auto&& solve, double refresh) {
    std::vector<double> history(5002, -1.0);
    Vector x = randomVector(s.b.size(), 3);
    const SolveReport whole = s.run(solve, s.jacobi(), x, {1e-12, 5000, refresh, history.data()});
    ASSERT_EQ(whole.status, SolveStatus::Converged);
    ASSERT_GT(whole.iterations, 10);
    EXPECT_EQ(history[0], whole.startResidual);
    EXPECT_EQ(history[whole.iterations], whole.residual);
    EXPECT_EQ(history[whole.iterations + 1], -1) << "nothing behind the end";
    // What a solve that is cut off there reports.
    for (int k : {1, 2, 9}) {
      x = randomVector(s.b.size(), 3);
      EXPECT_EQ(s.run(solve, s.jacobi(), x, {1e-12, k, refresh}).residual, history[k]);
      EXPECT_NEAR((s.b - s.a * x).squaredNorm() / s.b.squaredNorm(), history[k], 1e-12 * history[k]);
    }
  };
  check(cg, 0);
  check(cr, 0);
  check(cr, 1e-4);
}

TEST(Krylov, ReportsTheIterationLimit) {
  System s;
  Vector x = Vector::Zero(s.b.size());
  const SolveReport report = s.run(cg, s.jacobi(), x, {1e-24, 3});
  EXPECT_EQ(report.status, SolveStatus::IterationLimit);
  EXPECT_EQ(report.iterations, 3);
}

TEST(Krylov, ReportsAnIndefiniteOperator) {
  System s;
  s.a = -s.a;
  Vector x = Vector::Zero(s.b.size());
  const auto identity = [](Flat r, std::span<double> z) { std::copy(r.begin(), r.end(), z.begin()); };
  EXPECT_EQ(s.run(cg, identity, x, {1e-12, 100}).status, SolveStatus::Breakdown);
  x.setZero();
  EXPECT_EQ(s.run(cr, identity, x, {1e-12, 100}).status, SolveStatus::Breakdown);
}

TEST(Krylov, ReportsValuesThatAreNotFinite) {
  System s;
  s.b[3] = NAN;
  Vector x = Vector::Zero(s.b.size());
  EXPECT_EQ(s.run(cg, s.jacobi(), x, {1e-12, 100}).status, SolveStatus::NotFinite);
  EXPECT_EQ(s.run(cr, s.jacobi(), x, {1e-12, 100}).status, SolveStatus::NotFinite);
}

TEST(Krylov, AZeroRightHandSideHasTheZeroSolution) {
  System s;
  s.b.setZero();
  Vector x = Vector::Zero(s.b.size());
  const SolveReport report = s.run(cr, s.jacobi(), x, {1e-12, 100});
  EXPECT_EQ(report.status, SolveStatus::Converged);
  EXPECT_EQ(report.iterations, 0);
}

}  // namespace
}  // namespace treacle::test
