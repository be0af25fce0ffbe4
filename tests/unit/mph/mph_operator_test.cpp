#include "support/matrices.hpp"
#include "support/oracle.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/linear/block_csr.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace treacle::test {
namespace {

template <int D>
BlockCsr<D> assembled(Scene<D>& s) {
  GradientRows<D> rows;
  gradientRows(s.context, s.pairs(), rows);
  BlockCsr<D> a;
  assemble(s.context, s.pairs(), s.terms(), rows, a);
  return a;
}

template <int D>
void checkAgainstEquations(Walls walls, SchemeKind scheme, bool slips) {
  Scene<D> s = makeScene<D>({.walls = walls, .scheme = scheme, .slips = slips});
  const Matrix expected = Oracle<D>(s).matrix();
  MphOperator<D> a;
  a.prepare(s.context, s.pairs(), s.terms());
  const Matrix free = denseOf(s.unknowns(), [&](const Vector& x) { return applyOperator(s, a, x); });
  EXPECT_LT((free - expected).norm(), operatorTolerance * expected.norm());
  if (slips) return;
  EXPECT_LT((dense(assembled(s)) - expected).norm(), operatorTolerance * expected.norm());

  std::vector<Block<D>> diagonal(s.n());
  diagonalBlocks<D>(s.context, s.pairs(), s.terms(), diagonal);
  for (std::uint32_t i = 0; i < s.n(); ++i)
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c)
        ASSERT_NEAR(diagonal[i](r, c), expected(D * i + r, D * i + c), operatorTolerance * expected.norm());
}

TEST(Operator, EqualsTheEquationsMatrix) {
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate}) {
    for (const bool slips : {false, true}) {
      checkAgainstEquations<2>(Walls::Floor, scheme, slips);
      checkAgainstEquations<3>(Walls::Floor, scheme, slips);
    }
    checkAgainstEquations<2>(Walls::None, scheme, false);
  }
}

template <int D>
void checkMatrixFreeAgainstAssembled(SchemeKind scheme) {
  for (unsigned seed : {1u, 2u, 3u}) {
    Scene<D> s = makeScene<D>({.seed = seed, .jitter = 0.4, .scheme = scheme, .slips = false});
    MphOperator<D> a;
    a.prepare(s.context, s.pairs(), s.terms());
    const BlockCsr<D> matrix = assembled(s);
    const Vector x = randomVector(s.unknowns(), seed);
    const auto u = unflat<D>(x);
    std::vector<Vec<D>> y(u.size());
    multiply<D, double>(s.context, matrix, u, y);
    EXPECT_LT((applyOperator(s, a, x) - flat<D>(y)).norm(), operatorTolerance * flat<D>(y).norm());
  }
}

TEST(Operator, MatrixFreeEqualsAssembledOnRandomVectors) {
  for (const SchemeKind scheme : bothSchemes) {
    checkMatrixFreeAgainstAssembled<2>(scheme);
    checkMatrixFreeAgainstAssembled<3>(scheme);
  }
}

/// A u - rho/dt u = (dD/du) / dV  [K23 eqs. (8), (10)]
template <int D>
void checkDissipationGradient(SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.scheme = scheme});
  const Oracle<D> oracle(s);
  MphOperator<D> a;
  a.prepare(s.context, s.pairs(), s.terms());
  const Vector x = randomVector(s.unknowns(), 5);
  Vector all = Vector::Zero(D * oracle.count());
  all.setHead(x);
  Vector force = applyOperator(s, a, x);
  for (Index k = 0; k < s.unknowns(); ++k) force[k] -= oracle.material(k / D).density / oracle.dt * x[k];
  for (Index k = 0; k < s.unknowns(); k += 23) {
    Vector plus = all, minus = all;
    plus[k] += 1;
    minus[k] -= 1;
    const double gradient = (oracle.dissipation(plus) - oracle.dissipation(minus)) / 2 / s.volume();
    ASSERT_NEAR(force[k], gradient, operatorTolerance * force.cwiseAbs().maxCoeff()) << "unknown " << k;
  }
}

TEST(Operator, IsTheGradientOfTheDissipationFunction) {
  for (const SchemeKind scheme : bothSchemes) {
    checkDissipationGradient<2>(scheme);
    checkDissipationGradient<3>(scheme);
  }
}

template <int D>
void checkPositiveDefinite(SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.scheme = scheme});
  MphOperator<D> a;
  a.prepare(s.context, s.pairs(), s.terms());
  const Matrix m = denseOf(s.unknowns(), [&](const Vector& x) { return applyOperator(s, a, x); });
  EXPECT_LT((m - m.transpose()).norm(), operatorTolerance * m.norm());
  EXPECT_GE(eigenvalues(m)[0], 1.1e3 / 1e-3 * (1 - 1e-9));  // rho/dt of the lighter material
}

TEST(Operator, IsSymmetricPositiveDefinite) {
  for (const SchemeKind scheme : bothSchemes) {
    checkPositiveDefinite<2>(scheme);
    checkPositiveDefinite<3>(scheme);
  }
}

/// Without walls the viscous and pressure forces sum to zero, and so does their moment: pairwise, or with B
/// through each pressure's own moment B M, which is symmetric.
template <int D>
void checkMomentum(SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.walls = Walls::None, .scheme = scheme});
  MphOperator<D> a;
  a.prepare(s.context, s.pairs(), s.terms());
  const Vector x = randomVector(s.unknowns(), 6);
  Vector force = applyOperator(s, a, x);
  for (Index k = 0; k < s.unknowns(); ++k)
    force[k] -= s.c.materials[s.particles.material[k / D]].density / s.c.time.step * x[k];
  const auto f = unflat<D>(force);
  // The body crosses a periodic end; its particles beside the first one.
  Vec<3> sum{}, moment{};
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    sum += resized<3>(f[i]);
    moment += cross(resized<3>(Oracle<D>(s).difference(0, i)), resized<3>(f[i]));
  }
  EXPECT_LT(norm(sum), operatorTolerance * force.norm());
  EXPECT_LT(norm(moment), operatorTolerance * force.norm() * s.c.domain.max[0]);
}

TEST(Operator, ConservesMomentaWithoutWalls) {
  for (const SchemeKind scheme : bothSchemes) {
    checkMomentum<2>(scheme);
    checkMomentum<3>(scheme);
  }
}

/// Fluid on a floor, so much of it that every loop runs on all threads.
Scene<2> largeScene(SchemeKind scheme) {
  Scene<2> s;
  s.c = sceneCase(2, true, scheme);
  s.c.domain.max = {60e-3, 60e-3, 0};
  s.particles = jitteredLattice<2>(
      s.c, 0.2, 3, [](const Vec<2>& x) { return x[0] < 0.05 && x[1] > 0.006 && x[1] < 0.05; },
      [](const Vec<2>& x) { return x[1] < 0.006; });
  prepare(s);
  return s;
}

TEST(Operator, DoesNotDependOnTheNumberOfThreads) {
  for (const SchemeKind scheme : bothSchemes) {
    Vector products[2];
    BlockCsr<2> matrices[2];
    for (int run = 0; run < 2; ++run) {
      omp_set_num_threads(run == 0 ? 1 : 4);
      Scene<2> s = largeScene(scheme);
      ASSERT_GT(s.n() / clusterSize, parallelGrain / clusterSize);
      MphOperator<2> a;
      a.prepare(s.context, s.pairs(), s.terms());
      products[run] = applyOperator(s, a, randomVector(s.unknowns(), 7));
      matrices[run] = assembled(s);
    }
    omp_set_num_threads(1);
    EXPECT_EQ(products[0], products[1]) << nameOf(scheme);
    EXPECT_EQ(matrixDifference(matrices[0], matrices[1]), 0) << nameOf(scheme);
  }
}

TEST(Operator, TreatsOneMaterialAsTwoEqualOnes) {
  // Same constants under one name and under two: the sums must not care.
  Scene<3> two = makeScene<3>({.twoMaterials = false}), one = makeScene<3>({.twoMaterials = false});
  one.c.materials.pop_back();
  std::fill(one.particles.material.begin(), one.particles.material.end(), std::uint8_t{0});
  prepare(one);
  MphOperator<3> a, b;
  a.prepare(two.context, two.pairs(), two.terms());
  b.prepare(one.context, one.pairs(), one.terms());
  const Vector x = randomVector(two.unknowns(), 9), y = applyOperator(two, a, x);
  EXPECT_LT((y - applyOperator(one, b, x)).norm(), operatorTolerance * y.norm());
}

}  // namespace
}  // namespace treacle::test
