#include "treacle/precondition/isph_hat_multigrid.hpp"
#include "treacle/core/pseudo_random.hpp"

#include "support/isph_scene.hpp"
#include "support/tolerances.hpp"
#include "treacle/precondition/hat_cells.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Fluid particles only, as the preconditioner sees them.
template <int D>
SortedParticles<D> fluidOf(const IsphScene<D>& s) {
  SortedParticles<D> fluid = s.pairs;
  fluid.activeCount = fluid.fluidCount;
  fluid.cells.wallEnd = fluid.cells.wallBegin;
  return fluid;
}

/// A jittered body of water at the corner of an open domain: linear fields have no jumps at its ends.
template <int D>
IsphScene<D> makeBody(SchemeKind scheme = SchemeKind::Accurate) {
  Case c = waterCase(D, {17, 14, D == 3 ? 13.0 : 0});
  c.method.scheme = scheme;
  const Vec<D, int> count = resized<D>(D == 2 ? Vec<3, int>{13, 9} : Vec<3, int>{9, 8, 7});
  auto points = latticeAt<D>(Vec<D>::filled(1.5 * c.spacing), count, c.spacing);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < D; ++k) points[i][k] += 0.15 * c.spacing * pseudoRandom(D * i + k);
  return {c, particlesAt<D>(points)};
}

/// A field on particles and on nodes, linear in space.
template <int D>
struct LinearField {
  double constant;
  Vec<D> gradient;

  double at(const Vec<D>& x) const { return constant + dot(gradient, x); }
  Vector onParticles(const IsphScene<D>& s) const {
    Vector u(s.n());
    for (std::uint32_t i = 0; i < s.n(); ++i) u[i] = at(s.particles.position[i]);
    return u;
  }
  Vector onNodes(const IsphScene<D>& s, const HatNodes<D>& nodes) const {
    Vector u(nodes.count());
    for (std::uint32_t n = 0; n < nodes.count(); ++n) {
      const Vec<D, int> p = nodes.lattice.at(nodes.point[n]);
      Vec<D> x = s.pairs.grid.origin;
      for (int k = 0; k < D; ++k) x[k] += p[k] * s.pairs.grid.edge[k];
      u[n] = at(x);
    }
    return u;
  }
};

template <int D, class T>
struct Galerkin {
  IsphScene<D>& s;
  SortedParticles<D> fluid = fluidOf(s);
  HatNodes<D> nodes;
  Buffer<T> parts;
  BlockCsr<1> grid;
  Matrix a, coarse;

  template <class Row>
  Galerkin(IsphScene<D>& scene, const Row& row) : s(scene) {
    const IsphTestSystem<D, T> system(s, row);
    findHatNodes(s.context, fluid, HatsOn::Fluid, nodes);
    isphGalerkin(s.context, fluid, std::span<const IsphMoments<D>>(system.moments), nodes, parts, grid);
    a = dense(system.a);
    coarse = dense(grid);
  }

  /// v^T P^T A P u and what the operator makes of it.
  void compare(const LinearField<D>& v, const LinearField<D>& u, double factor) {
    const double exact = v.onParticles(s).dot(a * u.onParticles(s));
    const double scale =
        std::sqrt(v.onParticles(s).dot(a * v.onParticles(s)) * u.onParticles(s).dot(a * u.onParticles(s)));
    EXPECT_NEAR(v.onNodes(s, nodes).dot(coarse * u.onNodes(s, nodes)), factor * exact,
                3e-7 * scale);  // measured: 5e-8, of moments in single precision
  }
};

template <int D, class T>
void checkGalerkin(SchemeKind scheme) {
  IsphScene<D> s = makeBody<D>(scheme);
  LinearField<D> one{1, {}}, u{0, {}}, v{0, {}};
  u.gradient[0] = 70, u.gradient[1] = -20;
  v.gradient[D - 1] = 30, v.gradient[0] = 10;

  // Without known pressures energies of linear fields are those of pairs, but for the factor, and constants have
  // none.
  const std::vector<std::uint8_t> none(s.n());
  const std::vector<float> missing(s.missing.begin(), s.missing.end());
  std::fill(s.missing.begin(), s.missing.end(), 0);
  Galerkin<D, T> free(s, PressureRow<D>{none.data()});
  EXPECT_LE((free.coarse - free.coarse.transpose()).norm(), operatorTolerance * free.coarse.norm());
  free.compare(u, u, isphGalerkinFactor);
  free.compare(v, u, isphGalerkinFactor);
  EXPECT_LE((free.coarse * one.onNodes(s, free.nodes)).norm(), 1e-7 * free.coarse.norm());  // measured: 9e-9

  std::copy(missing.begin(), missing.end(), s.missing.begin());
  // What stands on the diagonal alone is exact against constants.
  Galerkin<D, T> held(s, PressureRow<D>{s.surface.data()});
  held.compare(one, one, 1);
  const Vector known = held.a.rowSums();
  EXPECT_NEAR(one.onNodes(s, held.nodes).dot(held.coarse * u.onNodes(s, held.nodes)), known.dot(u.onParticles(s)),
              1e-8 * known.norm() * u.onParticles(s).norm());  // measured: 5e-10
}

TEST(PairGalerkin, EqualsTheRestrictedMatrixForLinearFields) {
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate}) {
    checkGalerkin<2, double>(scheme);
    checkGalerkin<2, float>(scheme);
    checkGalerkin<3, double>(scheme);
    checkGalerkin<3, float>(scheme);
  }
}

template <int D>
void checkProduct() {
  // Against P^T A P itself: the same energies of smooth fields within a fifth, whatever the walls and ends.
  IsphScene<D> s = makeIsphScene<D>();
  const IsphTestSystem<D, double> system(s, ViscousRow<D>{});
  const SortedParticles<D> fluid = fluidOf(s);
  HatNodes<D> nodes;
  Buffer<double> parts;
  BlockCsr<1> grid;
  findHatNodes(s.context, fluid, HatsOn::Fluid, nodes);
  isphGalerkin(s.context, fluid, std::span<const IsphMoments<D>>(system.moments), nodes, parts, grid);
  const HatCells<D> cells{s.pairs.grid};
  Matrix p = Matrix::Zero(s.n(), nodes.count());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const Vec<D> x = s.particles.position[i];
    const Vec<D, int> cell = s.pairs.grid.cellOf(x);
    for (std::uint32_t n = 0; n < nodes.count(); ++n)
      p(i, n) = cells.hat(nodes.lattice.at(nodes.point[n]), cell, cells.fraction(x, cell));
    ASSERT_NEAR(p.row(i).sum(), 1, 1e-12);
  }
  const Matrix exact = p.transpose() * dense(system.a) * p, found = dense(grid);
  Vector one = Vector::Ones(nodes.count());
  EXPECT_NEAR(one.dot(found * one), one.dot(exact * one), 3e-8 * one.dot(exact * one));  // measured: 3e-9
  const Matrix regular = exact + 1e-9 * exact.norm() * Matrix::Identity(found.rows(), found.rows());
  EXPECT_GT(generalisedEigenvalues(found, regular)[0], 0.5);
}

TEST(PairGalerkin, IsNoSmallerThanTheRestrictedMatrix) {
  checkProduct<2>();
  checkProduct<3>();
}

/// K as a dense matrix.
template <int D, class T>
Matrix matrixOf(IsphScene<D>& s, const IsphTestSystem<D, T>& system, int degree, IsphHatMultigrid<D, T>& hats) {
  hats.setup(s.context, s.pairs, system.a, system.moments, degree);
  return denseOf(s.n(), [&](const Vector& r) {
    Vector z = Vector::Constant(r.size(), NAN);
    hats.apply(s.context, r, z);
    return z;
  });
}

template <int D, class T, class Row>
void checkPreconditioner(IsphScene<D>& s, const Row& row, int degree) {
  SCOPED_TRACE(testing::Message() << D << "D, " << (sizeof(T) == 4 ? "single" : "double") << ", degree "
                                  << degree);
  const double tolerance = sizeof(T) == 4 ? 10 * singleTolerance : operatorTolerance;
  const IsphTestSystem<D, T> system(s, row);
  IsphHatMultigrid<D, T> hats;
  Matrix k = matrixOf(s, system, degree, hats);
  EXPECT_LE((k - k.transpose()).norm(), tolerance * k.norm());
  EXPECT_GT(hats.gridLevels(), 0u);
  Matrix a = dense(system.a);
  // Zero at the surface, positive definite elsewhere: with ones there instead the whole is.
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    if (row.isUnknown(i)) continue;
    ASSERT_EQ(k.row(i).cwiseAbs().sum() + k.col(i).cwiseAbs().sum(), 0);
    k(i, i) = a(i, i) = 1;
  }
  const Matrix symmetric = (k + k.transpose()) / 2;
  EXPECT_GT(eigenvalues(symmetric)[0], 0);
  // And near enough to the inverse: the spectrum of K A is short.
  const Vector product = eigenvaluesOfProduct(symmetric, a);
  EXPECT_LT(product.maxCoeff() / product.minCoeff(), 6);
}

template <int D>
void checkPreconditioners() {
  for (const Walls walls : {Walls::Floor, Walls::None}) {
    IsphScene<D> s = makeIsphScene<D>(walls);
    for (const int degree : {1, 2}) {
      checkPreconditioner<D, double>(s, PressureRow<D>{s.surface.data()}, degree);
      checkPreconditioner<D, float>(s, PressureRow<D>{s.surface.data()}, degree);
      checkPreconditioner<D, double>(s, ViscousRow<D>{}, degree);
    }
  }
}

TEST(IsphHatMultigrid, IsSymmetricPositiveDefiniteOnTheUnknowns) {
  checkPreconditioners<2>();
  checkPreconditioners<3>();
}

TEST(IsphHatMultigrid, OfNothingButSurfaceIsZero) {
  Case c = waterCase(2, {20, 20, 0});
  c.method.scheme = SchemeKind::Published;
  for (const int count : {0, 1, 5}) {
    IsphScene<2> s(c, particlesAt<2>(latticeAt<2>({0.05, 0.05}, {count, 1}, c.spacing)));
    ASSERT_EQ(s.surfaceCount(), s.n());
    const IsphTestSystem<2, float> system(s, PressureRow<2>{s.surface.data()});
    IsphHatMultigrid<2, float> hats;
    EXPECT_EQ(matrixOf(s, system, 1, hats).norm(), 0);
  }
}

}  // namespace
}  // namespace treacle::test
