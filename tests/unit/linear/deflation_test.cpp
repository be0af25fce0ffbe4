#include "treacle/linear/deflation.hpp"
#include "treacle/linear/krylov.hpp"

#include "support/dense.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace treacle::test {
namespace {

using Flat = std::span<const double>;

/// Conjugate gradients without a preconditioner see of A only its eigenvalues: A is diagonal here.
struct Diagonal {
  Context<Cpu> context;
  KrylovWorkspace<> workspace;
  Deflation<> deflation;
  std::vector<double> values, b, x;

  /// `outliers` first, the others evenly between 1 and 2. Several chunks of a sum.
  explicit Diagonal(std::vector<double> outliers, std::size_t n = 10'000) : values(std::move(outliers)) {
    const std::size_t rest = n - values.size();
    for (std::size_t i = 0; i < rest; ++i) values.push_back(1 + double(i) / double(rest - 1));
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < n; ++i) b.push_back(normal(random) * (i < n - rest ? 30 : 1));
  }

  SolveReport solve(Deflation<>* how, double tolerance = 1e-12) {
    x.assign(b.size(), 0);
    const auto a = [&](Flat u, std::span<double> v) {
      for (std::size_t i = 0; i < u.size(); ++i) v[i] = values[i] * u[i];
    };
    const auto identity = [](Flat r, std::span<double> z) { std::copy(r.begin(), r.end(), z.begin()); };
    return conjugateGradient<Cpu>(context, {a, identity, b, x}, {tolerance, 200}, workspace, how);
  }
  SolveReport plain(double tolerance = 1e-12) { return solve(nullptr, tolerance); }
  SolveReport recorded() {
    deflation.record(context, b.size());
    return solve(&deflation);
  }
  SolveReport deflated(std::span<const float> modes, double tolerance = 1e-12) {
    deflation.deflateBy(modes, b.size());
    return solve(&deflation, tolerance);
  }
  std::vector<float> taken(const SolveReport& report, int most = 8) {
    const RitzVectors ritz = deflation.ritzVectors(context, report.iterations, most);
    std::vector<float> modes(ritz.modes * b.size());
    deflation.takeModes(context, ritz, modes);
    return modes;
  }
  double residual() const {
    double rr = 0, bb = 0;
    for (std::size_t i = 0; i < b.size(); ++i) rr += std::pow(b[i] - values[i] * x[i], 2), bb += b[i] * b[i];
    return rr / bb;
  }
  double rayleighQuotient(std::span<const float> mode) const {
    double above = 0, below = 0;
    for (std::size_t i = 0; i < mode.size(); ++i)
      above += values[i] * mode[i] * mode[i], below += double(mode[i]) * mode[i];
    return above / below;
  }
};

const std::vector<double> outliers{50, 40, 30, 20};

TEST(Deflation, TakesTheVectorsOfTheLargestValues) {
  Diagonal s(outliers);
  const SolveReport report = s.recorded();
  const std::vector<float> modes = s.taken(report);
  std::vector<double> found;
  for (std::size_t j = 0; j < modes.size() / s.b.size(); ++j)
    found.push_back(s.rayleighQuotient(std::span(modes).subspan(j * s.b.size(), s.b.size())));
  EXPECT_LE(found.size(), outliers.size() + 2) << "more than copies by rounding";
  for (const double value : outliers)
    EXPECT_TRUE(std::ranges::any_of(found, [&](double f) { return std::abs(f - value) < 1e-3 * value; })) << value;
  EXPECT_EQ(s.taken(report, 2).size(), 2 * s.b.size());
}

TEST(Deflation, LeavesTheIterationsOfTheOtherEigenvalues) {
  Diagonal s(outliers), without({});
  // Without the outliers the error of CG falls by (sqrt 2 - 1) / (sqrt 2 + 1) at least.
  const int expected = without.plain().iterations;
  EXPECT_LE(expected, std::log(1e-6 / 2 / std::sqrt(2)) / std::log((std::sqrt(2) - 1) / (std::sqrt(2) + 1)) + 1);
  const SolveReport report = s.recorded();
  EXPECT_GE(report.iterations, expected + 4);
  const std::vector<float> modes = s.taken(report);
  const SolveReport deflated = s.deflated(modes);
  EXPECT_LE(deflated.iterations, expected + 1);
  EXPECT_LE(s.residual(), 1.01e-12);

  // Modes of the operator as it was.
  for (std::size_t i = 0; i < s.values.size(); ++i) s.values[i] *= 1 + 0.01 * std::sin(double(i));
  EXPECT_LE(s.deflated(modes).iterations, expected + 2);
}

TEST(Deflation, ReachesTheResidualThatPlainDirectionsReach) {
  Diagonal s(outliers);
  const std::vector<float> modes = s.taken(s.recorded());
  s.plain(1e-26);
  EXPECT_LE(s.residual(), 1.1e-26);
  EXPECT_EQ(s.deflated(modes, 1e-26).status, SolveStatus::Converged);
  EXPECT_LE(s.residual(), 1.1e-26);
}

TEST(Deflation, RecordingChangesNothingAndFindsNoModesWhereNoneArePaying) {
  Diagonal s({2.9, 0.5});
  const SolveReport plain = s.plain();
  const std::vector<double> x = s.x;
  const auto expectSame = [&](const SolveReport& report) {
    EXPECT_EQ(report.iterations, plain.iterations);
    EXPECT_EQ(report.residual, plain.residual);
    EXPECT_EQ(s.x, x);
  };
  expectSame(s.recorded());
  EXPECT_EQ(s.deflation.ritzVectors(s.context, plain.iterations, 8).modes, 0);
  s.deflation.recordNumbers(s.context);
  expectSame(s.solve(&s.deflation));
  EXPECT_EQ(s.deflation.ritzVectors(s.context, plain.iterations, 8).modes, 0);
  expectSame(s.deflated({}));
}

TEST(Deflation, LongSolvesAreRecordedInPart) {
  std::vector<double> many;
  for (int i = 0; i < 60; ++i) many.push_back(4 + i * i);
  Diagonal s(many);
  const SolveReport report = s.recorded();
  EXPECT_GT(report.iterations, DeflationScalars::maxBasis);
  EXPECT_LT(s.deflated(s.taken(report, 16)).iterations, report.iterations);
}

TEST(Deflation, ModesThatDependOnOthersAreLeftOut) {
  Diagonal s(outliers);
  std::vector<float> modes = s.taken(s.recorded());
  const int expected = s.deflated(modes).iterations;
  modes.insert(modes.end(), modes.begin(), modes.begin() + 2 * s.b.size());  // two of them again
  modes.insert(modes.end(), s.b.size(), 0.0f);
  EXPECT_EQ(s.deflated(modes).iterations, expected);
  EXPECT_LE(s.residual(), 1.01e-12);
}

TEST(Deflation, ModesThatAreNotFiniteAreNotUsed) {
  Diagonal s(outliers);
  const SolveReport plain = s.plain();
  const SolveReport report = s.deflated(std::vector<float>(2 * s.b.size(), NAN));
  EXPECT_EQ(report.status, SolveStatus::Converged);
  EXPECT_EQ(report.iterations, plain.iterations);
}

TEST(Deflation, InvertsTheSmallMatrix) {
  const int n = 7;
  const Matrix root = Matrix::Random(n, n);
  Matrix e = root * root.transpose();
  ModeMatrix given{}, inverse{};
  const auto invertIt = [&] {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) given(i, j) = e(i, j);
    return invert(given, n, inverse);
  };
  EXPECT_EQ(invertIt(), n);
  const Matrix exact = treacle::test::inverse(e);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) EXPECT_NEAR(inverse(i, j), exact(i, j), 1e-12 * exact.norm());

  // Without the third row and column.
  e.setRow(2, e.row(0)), e.setCol(2, e.col(0)), e(2, 2) = e(0, 0);
  EXPECT_EQ(invertIt(), n - 1);
  EXPECT_EQ(inverse(2, 2), 0);
  EXPECT_EQ(inverse(5, 2), 0);
  double product = 0;
  for (int j = 0; j < n; ++j) product += e(5, j) * inverse(j, 5);
  EXPECT_NEAR(product, 1, 1e-12);
}

}  // namespace
}  // namespace treacle::test
