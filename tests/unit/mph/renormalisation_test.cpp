#include "treacle/mph/renormalisation.hpp"

#include "support/oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <random>

namespace treacle::test {
namespace {

constexpr double matrixTolerance = 1e-14;

/// sum_k values_k v_k v_k^T for orthonormal v_k in random directions.
template <int D>
SymmetricBlock<D> momentOf(const Vec<D>& values, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vec<D> v[D];
  for (int k = 0; k < D; ++k) {
    for (int r = 0; r < D; ++r) v[k][r] = normal(random);
    for (int pass = 0; pass < 2; ++pass)  // twice is enough
      for (int o = 0; o < k; ++o) v[k] -= dot(v[k], v[o]) * v[o];
    v[k] *= 1 / norm(v[k]);
  }
  SymmetricBlock<D> m{};
  for (int k = 0; k < D; ++k) m.addOuter(values[k], v[k]);
  return m;
}

template <int D>
Matrix matrixOf(const SymmetricBlock<D>& m) {
  Matrix full(D, D);
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) full(r, c) = m(r, c);
  return full;
}

template <int D>
void checkAgainstEigenSystem(const Vec<D>& values, std::mt19937& random) {
  for (int k = 0; k < 200; ++k) {
    const SymmetricBlock<D> m = momentOf<D>(values, random);
    const Matrix found = matrixOf(renormalisationOf(m)),
                 expected = renormalisationOracle(matrixOf(m), matrixOf(m));
    ASSERT_LE((found - expected).norm(), matrixTolerance)
        << values[0] << ", " << values[1] << ", " << values[D - 1];
  }
}

TEST(Renormalisation, IsTheFunctionOfTheMomentsEigenSystem) {
  std::mt19937 random(1);
  for (const Vec<2>& values : {Vec<2>{1.1, 0.5},
                               {0.7, 0.2},
                               {1.0, 1.0 + 1e-15},
                               {0.9, 0.9 - 1e-9},
                               {0.6, 0},
                               {0, 0},
                               {1e-200, 1e-170},
                               {3, 2}})
    checkAgainstEigenSystem<2>(values, random);
  for (const Vec<3>& values : {Vec<3>{1.1, 0.9, 0.5},
                               {0.8, 0.3, 0.1},
                               {1, 1, 0.4},
                               {1, 1 + 1e-15, 1 - 1e-15},
                               {0.9, 0.9 + 1e-8, 0.9 - 1e-8},
                               {0.5, 0.5 + 1e-9, 1e-9},
                               {0.7, 0.4, 0},
                               {0.6, 0, 0},
                               {0, 0, 0},
                               {1e-200, 1e-180, 1e-160},
                               {3, 2, 1.5}})
    checkAgainstEigenSystem<3>(values, random);
  std::uniform_real_distribution<double> any(0, 1.3);
  for (int k = 0; k < 200; ++k) {
    checkAgainstEigenSystem<2>({any(random), any(random)}, random);
    checkAgainstEigenSystem<3>({any(random), any(random), any(random)}, random);
  }
}

TEST(Renormalisation, IsTheUnitMatrixForDiagonalMoments) {
  for (const double m : {0.0, 0.1, 0.5, 0.98, 1.0}) {
    EXPECT_LE((matrixOf<2>(renormalisationOf(SymmetricBlock<2>{{m, 0, m}})) - Matrix::Identity(2, 2)).norm(), 0);
    EXPECT_LE(
        (matrixOf<3>(renormalisationOf(SymmetricBlock<3>{{m, 0, 0, m, 0, m}})) - Matrix::Identity(3, 3)).norm(),
        0);
  }
}

/// Particles at undisturbed lattice points that fill the domain, or the part of it that `where` accepts.
template <int D>
Scene<D> latticeScene(double jitter, const Where<D>& where) {
  Scene<D> s;
  s.c = sceneCase(D, false, SchemeKind::Accurate);
  s.particles = jitteredLattice<D>(s.c, jitter, 4, where, [](const Vec<D>&) { return false; });
  prepare(s);
  return s;
}

template <int D>
void checkFullLattice() {
  const Scene<D> s = latticeScene<D>(0, [](const Vec<D>&) { return true; });
  const Matrix moment = Oracle<D>(s).moment(0);
  ASSERT_LE((moment - Matrix::Identity(D, D)).norm(), 1e-12);
  for (const SymmetricBlock<D>& b : s.renormalisation)
    ASSERT_LE((matrixOf(b) - Matrix::Identity(D, D)).norm(), 1e-12);
}

TEST(Renormalisation, IsTheUnitMatrixInAFullLattice) {
  checkFullLattice<2>();
  checkFullLattice<3>();
}

/// u = G x + u_0 has C^T u = -tr G, whatever is cut off, but for the factor and where neighbours are too few.
template <int D>
void checkLinearFields() {
  const auto inside = [](const Vec<D>& x) {
    double along = 0, square = 0;
    for (int k = 0; k < D; ++k) along += (k + 1) * x[k], square += std::pow(x[k] - 8e-3, 2);
    return square < std::pow(6e-3, 2) && along > (D == 2 ? 20e-3 : 40e-3);
  };
  Scene<D> s = latticeScene<D>(0.25, inside);
  const Oracle<D> oracle(s);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uint32_t exact = 0, cut = 0;
  for (int field = 0; field < 3; ++field) {
    Block<D> g{};
    double trace = 0, size = 0;
    for (int k = 0; k < D * D; ++k) g.a[k] = normal(random), size += std::abs(g.a[k]);
    for (int k = 0; k < D; ++k) trace += g(k, k);
    std::vector<Vec<D>> u;
    for (std::uint32_t i = 0; i < s.n(); ++i) u.push_back(g * s.particles.position[i] + Vec<D>::filled(0.3));
    std::vector<double> div(s.pairs().activeCount);
    divergence<D>(s.context, s.pairs(), u, div);
    for (std::uint32_t i = 0; i < s.n(); ++i) {
      const double least = eigenvalues(oracle.moment(i)).minCoeff();
      if (least < leastMoment) {
        ++cut;
        continue;
      }
      ++exact;
      ASSERT_NEAR(div[i], -std::min(1.0, least) * trace, 1e-12 * size) << "particle " << i;
    }
  }
  EXPECT_GT(exact, 3 * s.n() / 2);  // most of them are at a surface
  EXPECT_GT(cut, 0u);
}

TEST(Renormalisation, MakesDivergencesOfLinearVelocitiesExact) {
  checkLinearFields<2>();
  checkLinearFields<3>();
}

/// For any pressures.
template <int D>
void checkMomenta() {
  Scene<D> s = makeScene<D>({.walls = Walls::None, .jitter = 0.4, .scheme = SchemeKind::Accurate});
  const Vector q = randomVector(s.n(), 3);
  std::vector<Vec<D>> force(s.n(), Vec<D>{});
  addPressureGradient<D>(s.context, s.pairs(), {q.data(), s.n()}, 1, force);
  const Oracle<D> oracle(s);
  Vec<3> sum{}, moment{};
  double sums = 0, moments = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const Vec<3> f = resized<3>(force[i]), x = resized<3>(oracle.difference(0, i));
    sum += f, moment += cross(x, f);
    sums += norm(f), moments += norm(cross(x, f));
  }
  EXPECT_LE(norm(sum), 1e-14 * sums);
  EXPECT_LE(norm(moment), 1e-14 * moments);
}

TEST(Renormalisation, ConservesMomentumAndAngularMomentum) {
  checkMomenta<2>();
  checkMomenta<3>();
}

template <int D>
void checkSums(Walls walls) {
  const Scene<D> s = makeScene<D>({.walls = walls, .jitter = 0.4, .scheme = SchemeKind::Accurate});
  const Oracle<D> oracle(s);
  for (std::uint32_t i = 0; i < s.n(); ++i)
    ASSERT_LE((matrixOf(s.renormalisation[i]) - oracle.renormalisation(i)).norm(), operatorTolerance)
        << "particle " << i;
}

TEST(Renormalisation, IsThatOfTheSumOverAllParticles) {
  for (const Walls walls : {Walls::Floor, Walls::None}) {
    checkSums<2>(walls);
    checkSums<3>(walls);
  }
}

}  // namespace
}  // namespace treacle::test
