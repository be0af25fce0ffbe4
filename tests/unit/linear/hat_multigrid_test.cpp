#include "treacle/linear/hat_multigrid.hpp"

#include "support/dense.hpp"
#include "support/hats.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace treacle::test {
namespace {

template <int D, int B>
Matrix interpolation(const HatNodes<D>& fine, const HatNodes<D>& coarse) {
  Matrix p = Matrix::Zero(B * fine.count(), B * coarse.count());
  for (std::uint32_t i = 0; i < fine.count(); ++i)
    forEachCoarse(fine.lattice, fine.lattice.at(fine.point[i]), [&](const Vec<D, int>& c, double weight) {
      const std::uint32_t node = coarse.nodeAt[coarse.lattice.linear(c)];
      ASSERT_NE(node, noNode);
      for (int k = 0; k < B; ++k) p(B * i + k, B * node + k) += weight;
    });
  return p;
}

template <int D, int B>
void checkGalerkin() {
  Context<Cpu> context;
  for (const HatCase<D>& c : hatCases<D>(D == 2 ? 12 : B == 1 ? 6 : 5)) {
    SCOPED_TRACE(testing::Message() << D << "-D, " << c.name);
    const HatProblem<D, B> problem(c);
    HatNodes<D> coarse;
    BlockCsr<B> coarseA;
    coarserNodes<D>(context, problem.nodes, coarse);
    coarsenHats<D>(context, problem.nodes, problem.a, coarse, coarseA, problem.reach);
    const Matrix p = interpolation<D, B>(problem.nodes, coarse);
    EXPECT_EQ(p.rowSums(), Vector::Ones(p.rows()));
    for (Index k = 0; k < p.cols(); ++k) EXPECT_GT(p.col(k).norm(), 0) << "a coarse node without use";
    const Matrix expected = p.transpose() * dense(problem.a) * p;
    EXPECT_LE((dense(coarseA) - expected).norm(), operatorTolerance * expected.norm());
    for (std::uint32_t i = 0; i < coarse.count(); ++i) {
      std::vector<std::uint32_t> row(coarseA.column.begin() + coarseA.rowStart[i],
                                     coarseA.column.begin() + coarseA.rowStart[i + 1]);
      std::sort(row.begin(), row.end());
      EXPECT_EQ(std::adjacent_find(row.begin(), row.end()), row.end()) << "a column twice";
      EXPECT_TRUE(std::binary_search(row.begin(), row.end(), i));
    }
  }
}

TEST(HatNodes, CoarseOperatorIsTheGalerkinProduct) {
  checkGalerkin<2, 1>();
  checkGalerkin<3, 1>();
  checkGalerkin<2, 2>();
  checkGalerkin<3, 3>();
}

TEST(HatNodes, AreNumberedInTheOrderOfTheLattice) {
  Context<Cpu> context;
  HatNodes<2> nodes;
  numberNodes<2>(context, {{3, 2}, {}}, std::vector<std::uint8_t>{0, 1, 0, 2, 0, 1}, nodes);
  EXPECT_EQ((std::vector<std::uint32_t>(nodes.point.begin(), nodes.point.end())),
            (std::vector<std::uint32_t>{1, 3, 5}));
  EXPECT_EQ((std::vector<std::uint32_t>(nodes.nodeAt.begin(), nodes.nodeAt.end())),
            (std::vector<std::uint32_t>{noNode, 0, noNode, 1, noNode, 2}));
}

/// solution of one cycle for the right-hand side b.
template <int D, class T, int B>
Vector solve(HatMultigrid<D, T, Cpu, B>& multigrid, const Vector& b) {
  Context<Cpu> context;
  for (Index i = 0; i < b.size(); ++i) multigrid.rhs()[i] = static_cast<T>(b[i]);
  multigrid.cycle(context);
  Vector x(b.size());
  for (Index i = 0; i < b.size(); ++i) x[i] = multigrid.solution()[i];
  return x;
}

template <int D, class T, int B = 1>
void checkSymmetric(double tolerance) {  // as the inverse of singular operators allows
  Context<Cpu> context;
  for (const HatCase<D>& c : hatCases<D>(D == 2 ? 14 : B == 1 ? 6 : 4))
    for (int degree : {1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << D << "-D, " << c.name << ", degree " << degree);
      const HatProblem<D, B> problem(c);
      HatMultigrid<D, T, Cpu, B> multigrid(20 * B);
      multigrid.setup(context, problem.nodes, problem.a, {degree, problem.reach});
      const Matrix m = denseOf(static_cast<Index>(problem.unknowns()), [&](const Vector& b) {
        const Vector x = solve(multigrid, b);
        EXPECT_EQ(x, solve(multigrid, b)) << "a cycle depends on the one before";
        return x;
      });
      EXPECT_LE((m - m.transpose()).norm(), tolerance * m.norm());
      if (m.rows() == 0) continue;
      EXPECT_GT(eigenvalues((m + m.transpose()) / 2)[0], 0);
    }
}

TEST(HatMultigrid, IsSymmetricPositiveDefinite) {
  checkSymmetric<2, double>(1e-6);
  checkSymmetric<3, double>(1e-6);
  checkSymmetric<2, float>(1e-4);
  checkSymmetric<3, float>(1e-4);
  checkSymmetric<2, double, 2>(1e-6);
  checkSymmetric<3, double, 3>(1e-6);
  checkSymmetric<2, float, 2>(1e-4);
}

/// Factor by which the cycle, as an iteration of its own, reduces the energy norm of the error per cycle.
template <int D, class T, int B>
double contraction(HatMultigrid<D, T, Cpu, B>& multigrid, const BlockCsr<B>& a) {
  Context<Cpu> context;
  const std::uint32_t n = B * a.rows();
  const auto times = [&](const Vector& x) {
    Vector y(n);
    hatMultiply<double>(context, viewOf(a), x, y);
    return y;
  };
  Vector e = randomVector(n, 1);
  double energy = 0, factor = 0;
  for (int k = 0; k < 12; ++k) {
    e /= e.norm();
    const Vector ae = times(e);
    energy = std::sqrt(e.dot(ae));
    e -= solve(multigrid, ae);
    factor = std::sqrt(e.dot(times(e))) / energy;
  }
  return factor;
}

template <int D, class T, int B = 1>
void checkContraction() {
  Context<Cpu> context;
  for (const HatCase<D>& c : hatCases<D>(D == 2 ? 70 : 17))
    for (int degree : {1, 3}) {
      SCOPED_TRACE(testing::Message() << D << "-D, " << c.name << ", degree " << degree);
      const HatProblem<D, B> problem(c, 1e-3);
      if (problem.nodes.count() < 2) continue;
      HatMultigrid<D, T, Cpu, B> multigrid(60 * B);
      multigrid.setup(context, problem.nodes, problem.a, {degree, problem.reach});
      const double factor = contraction(multigrid, problem.a);
      // Hats cannot tell the two sides of a gap apart, and hardly gather scattered nodes. The smoother knows
      // nothing of how the components of a node couple.
      const bool gap = c.name == "ball that nearly touches its image", scattered = c.name == "scattered";
      EXPECT_LT(factor, scattered     ? 1
                        : gap         ? (B == 1 ? 0.8 : 0.9)
                        : degree == 1 ? (B == 1 ? 0.5 : 0.75)
                                      : (B == 1 ? 0.2 : 0.25))
          << multigrid.levelCount() << " levels";
    }
}

TEST(HatMultigrid, ReducesErrorsOfAllWavelengths) {
  checkContraction<2, double>();
  checkContraction<3, double>();
  checkContraction<2, float>();
  checkContraction<2, double, 2>();
  checkContraction<3, double, 3>();
  checkContraction<2, float, 2>();
}

}  // namespace
}  // namespace treacle::test
