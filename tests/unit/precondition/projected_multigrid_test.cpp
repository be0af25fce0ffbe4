#include "treacle/precondition/projected_multigrid.hpp"

#include "support/oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

constexpr std::pair<Walls, SchemeKind> scenes[] = {{Walls::Floor, SchemeKind::Published},
                                                   {Walls::None, SchemeKind::Published},
                                                   {Walls::Floor, SchemeKind::Accurate}};

/// Fluid that fills part of a domain of `size` spacings, which is three to five search cells, and its floor.
template <int D>
Scene<D> bodyIn(double size, bool periodic, Walls walls) {
  Scene<D> s;
  s.c = sceneCase(D);
  for (int k = 0; k < D; ++k) s.c.domain.max[k] = size * s.c.spacing, s.c.domain.periodic[k] = periodic;
  const double floor = walls == Walls::Floor ? 3 : 1, width = D == 2 ? size - 3 : 5;
  s.particles = jitteredLattice<D>(
      s.c, 0.2, 5,
      [&](const Vec<D>& x) {
        const Vec<D> y = x * (1 / s.c.spacing);
        return y[0] > 1 && y[0] < 1 + width && y[D - 1] > floor && y[D - 1] < floor + 6 && (D == 2 || y[1] < 5);
      },
      [&](const Vec<D>& x) { return walls == Walls::Floor && x[D - 1] < floor * s.c.spacing; });
  prepare(s);
  return s;
}

/// Dense S', K0 and P of a scene by the products on unit vectors.
template <int D, class T>
struct Parts {
  Scene<D> s;
  ProjectionConstants constants;
  MphOperator<D> a;
  ParticleProducts<D, T> products;

  explicit Parts(Scene<D> scene) : s(std::move(scene)), constants(projectionConstants(s.pairs())) {
    a.prepare(s.context, s.pairs(), s.terms());
    products.prepare(s.context, s.pairs(), s.terms(), a);
  }

  Index active() const { return s.pairs().activeCount; }
  const std::uint8_t* material() const { return s.pairs().material.data(); }

  Matrix pressureMatrix() {
    const ProjectionTable<T> table = constants.table<T>();
    return denseOf(active(), [&](const Vector& e) {
      Buffer<T> x(active()), y(active());
      for (Index k = 0; k < active(); ++k) x[k] = static_cast<T>(e[k]);
      products.gather(s.context, x.span());
      products.gradient(s.context, products.scalars(),
                        StoreWeighted<D, T, Cpu>{table, material(), products.vectors()});
      products.divergence(s.context, products.vectors(),
                          StorePressure<T, Cpu>{table, material(), products.scalars(), y.data()});
      Vector result(active());
      for (Index k = 0; k < active(); ++k) result[k] = y[k];
      return result;
    });
  }

  /// The same by the products of the smoother.
  Matrix schurMatrix() {
    const ProjectionTable<T> table = constants.table<T>();
    return denseOf(active(), [&](const Vector& e) {
      Buffer<T> x(active()), y(active());
      for (Index k = 0; k < active(); ++k) x[k] = static_cast<T>(e[k]);
      products.gather(s.context, x.span());
      products.schur(s.context, table, products.scalars(),
                     StorePressure<T, Cpu>{table, material(), products.scalars(), y.data()});
      Vector result(active());
      for (Index k = 0; k < active(); ++k) result[k] = y[k];
      return result;
    });
  }

  Matrix velocityMatrix() {
    return denseOf(s.unknowns(), [&](const Vector& e) {
      Buffer<Gathered<D, T>> x(s.n()), residual(s.n());
      for (Index k = 0; k < s.unknowns(); ++k) x[k / D][k % D] = static_cast<T>(e[k]), residual[k / D][k % D] = 0;
      const VelocityStep<D, T, true> step{nullptr, T(0), T(0), {residual.data(), x.data(), nullptr}, nullptr};
      products.viscous(s.context, x.data(), step);
      Vector y(s.unknowns());
      for (Index k = 0; k < s.unknowns(); ++k) y[k] = -residual[k / D][k % D];
      return y;
    });
  }

  /// P of scalars, from nodes to particles.
  Matrix prolongation(const HatNodes<D>& nodes) {
    HatTransfer<D, T> transfer;
    transfer.prepare(s.context, s.pairs());
    Matrix p(active(), nodes.count());
    for (std::uint32_t n = 0; n < nodes.count(); ++n) {
      Buffer<T> e(nodes.count()), z(active()), x(active());
      std::fill(e.begin(), e.end(), T(0)), std::fill(x.begin(), x.end(), T(0));
      e[n] = 1;
      transfer.prolong(s.context, nodes, std::span<const T>(e), ScalarField<T, Cpu>{z.data()}, x.span());
      for (Index k = 0; k < active(); ++k) p(k, n) = z[k];
    }
    return p;
  }
};

/// S' and K0 from the formulas of the paper and the weights of the preconditioner; `reach` of C in h_p.
template <int D>
Matrix pressureOracle(const Scene<D>& s, const ProjectionConstants& constants, double reach = 1) {
  const Oracle<D> oracle(s);
  const Index active = s.pairs().activeCount;
  const Matrix c = oracle.gradientMatrix(reach);
  EXPECT_EQ(c.rightCols(c.cols() - active).norm(), 0) << "a wall that matters is not active";
  Vector w(s.unknowns()), shift(active);
  for (Index k = 0; k < w.size(); ++k) w[k] = constants.weight[s.particles.material[k / D]];
  for (Index k = 0; k < active; ++k) shift[k] = pressureShift / oracle.bulkViscosity(k);
  Matrix expected = c.leftCols(active).transpose() * w.asDiagonal() * c.leftCols(active);
  expected.addToDiagonal(shift);
  return expected;
}
template <int D>
Matrix velocityOracle(const Scene<D>& s) {
  const Oracle<D> oracle(s);
  Matrix k0 = oracle.viscosityMatrix();
  for (Index k = 0; k < k0.rows(); ++k) k0(k, k) += oracle.material(k / D).density / oracle.dt;
  return k0;
}

/// What the bits of PackedRows leave of S' in single precision; measured: 2.7e-5 and 1.2e-3.
template <int D, class T>
constexpr double schurTolerance = std::is_same_v<T, double> ? operatorTolerance
                                  : D == 2                  ? 1e-4
                                                            : 2e-3;

template <int D, class T>
void checkProducts(Scene<D> scene, double tolerance) {
  Parts<D, T> parts(std::move(scene));
  Scene<D>& s = parts.s;
  const Matrix pressure = parts.pressureMatrix(), velocity = parts.velocityMatrix();
  // With B, products in single precision leave out what is next to nothing of the weight of the accurate scheme.
  const bool all = std::is_same_v<T, double> || !s.c.isAccurate();
  const Matrix expected = pressureOracle(s, parts.constants, all ? 1 : 0.92);
  EXPECT_LT((pressure - expected).norm(), tolerance * expected.norm());
  EXPECT_LT((velocity - velocityOracle(s)).norm(), tolerance * velocity.norm());
  const Matrix schur = parts.schurMatrix();
  EXPECT_LT((schur - expected).norm(), (schurTolerance<D, T>)*expected.norm());
  EXPECT_LT((schur - schur.transpose()).norm(), tolerance * expected.norm());

  Buffer<T> inversePressure(parts.active());
  Buffer<Block<D, T>> inverseVelocity(s.n());
  parts.products.inverseDiagonals(s.context, parts.constants.template table<T>(), inversePressure,
                                  inverseVelocity);
  for (Index k = 0; k < parts.active(); ++k) {
    const double ratio = inversePressure[k] * pressure(k, k);
    if (k < s.n() || !s.c.hasSmoothWalls()) {
      ASSERT_NEAR(ratio, 1, 100 * tolerance) << "particle " << k;
    } else {  // that of walls has elements along them, too
      ASSERT_LT(ratio, 1 + 100 * tolerance) << "wall particle " << k;
      ASSERT_GT(ratio, 0.2) << "wall particle " << k;
    }
  }
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    Matrix inverse(D, D);
    for (int e = 0; e < D * D; ++e) inverse(e / D, e % D) = inverseVelocity[i].a[e];
    const Matrix block = velocity.block(D * i, D * i, D, D);
    ASSERT_LT((inverse * block - Matrix::Identity(D, D)).norm(), 100 * tolerance) << i;
  }

  Buffer<double> resisting(s.n());
  parts.products.resistingViscosity(s.context, parts.constants.resistance, resisting.span());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    double mean = 0;  // of what the particle's own velocity meets in V
    for (int k = 0; k < D; ++k) mean += velocity(D * i + k, D * i + k) / D;
    const double inertia = Oracle<D>(s).material(i).density / s.c.time.step;
    ASSERT_NEAR(resisting[i] * parts.constants.resistance, mean - inertia, 100 * tolerance * mean) << i;
  }
}

TEST(ParticleProducts, AreThoseOfTheFormulasAndInverseDiagonalsAreTheirs) {
  for (const auto& [walls, scheme] : scenes) {
    checkProducts<2, double>(makeScene<2>({.walls = walls, .scheme = scheme, .slips = false}), operatorTolerance);
    checkProducts<3, double>(makeScene<3>({.walls = walls, .scheme = scheme, .slips = false}), operatorTolerance);
    for (const bool slips : {false, true}) {
      const SceneOptions options{.walls = walls, .scheme = scheme, .slips = slips};
      checkProducts<2, float>(makeScene<2>(options), 3 * singleTolerance);
      checkProducts<3, float>(makeScene<3>(options), 3 * singleTolerance);
    }
  }
}

/// Every column of P sums up what the hat at one node says; the hats sum up to one.
template <int D>
void checkPressureGalerkin(Scene<D> scene) {
  Parts<D, double> parts(std::move(scene));
  Scene<D>& s = parts.s;
  HatNodes<D> nodes;
  findHatNodes(s.context, s.pairs(), HatsOn::Active, nodes);
  Buffer<Vec<D>> columns;
  BlockCsr<1> matrix;
  pressureGalerkin(s.context, s.pairs(), parts.constants.template table<double>(), nodes, columns, matrix);
  const Matrix p = parts.prolongation(nodes);
  EXPECT_LT((p * Vector::Ones(p.cols()) - Vector::Ones(p.rows())).norm(), operatorTolerance);
  const Matrix expected = p.transpose() * pressureOracle(s, parts.constants) * p;
  EXPECT_LT((dense(matrix) - expected).norm(), operatorTolerance * expected.norm());

  HatTransfer<D, double> transfer;
  transfer.prepare(s.context, s.pairs());
  const Vector r = randomVector(parts.active(), 8);
  std::vector<double> b(nodes.count());
  transfer.restrict(s.context, nodes, std::span<const double>(r), std::span<double>(b));
  const Vector restricted = p.transpose() * r;
  EXPECT_LT((Vector(b) - restricted).norm(), operatorTolerance * restricted.norm());
}

TEST(HatGrid, PressureGalerkinOperatorIsTheRestrictedMatrix) {
  for (const auto& [walls, scheme] : scenes) {
    checkPressureGalerkin<2>(makeScene<2>({.walls = walls, .scheme = scheme, .slips = false}));
    checkPressureGalerkin<3>(makeScene<3>({.walls = walls, .scheme = scheme, .slips = false}));
    for (const bool periodic : {true, false}) {
      checkPressureGalerkin<2>(bodyIn<2>(11, periodic, walls));
      checkPressureGalerkin<3>(bodyIn<3>(11, periodic, walls));
    }
  }
}

/// Hats reproduce velocities that are linear in x, and their gradients: energies of such fields are exact but for
/// the factor of the viscous part.
template <int D>
void checkViscousGalerkin() {
  Parts<D, double> parts(bodyIn<D>(D == 2 ? 16 : 12, false, Walls::None));
  Scene<D>& s = parts.s;
  HatNodes<D> nodes;
  findHatNodes(s.context, s.pairs(), HatsOn::Fluid, nodes);
  Buffer<ViscousMoments<D, double>> moments;
  BlockCsr<D> matrix;
  viscousGalerkin(s.context, s.pairs(), s.terms(), nodes, moments, matrix);
  const Matrix grid = dense(matrix);
  EXPECT_LT((grid - grid.transpose()).norm(), operatorTolerance * grid.norm());
  EXPECT_GT(eigenvalues(grid)[0], -operatorTolerance * grid.norm());

  const Oracle<D> oracle(s);
  Vector inertia(s.unknowns());
  for (Index k = 0; k < inertia.size(); ++k) inertia[k] = oracle.material(k / D).density / oracle.dt;
  const Matrix viscosity = oracle.viscosityMatrix();
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Vector numbers = randomVector(D * D + D, seed);
    const auto field = [&](const Vec<D>& x, int k) {
      double u = 0;
      for (int c = 0; c < D; ++c) u += numbers[D * k + c] * x[c] / s.c.spacing;
      return u + numbers[D * D + k];
    };
    Vector e(D * nodes.count()), u(s.unknowns());
    for (std::uint32_t n = 0; n < nodes.count(); ++n) {
      const Vec<D, int> node = nodes.lattice.at(nodes.point[n]);
      Vec<D> x;
      for (int k = 0; k < D; ++k) x[k] = s.pairs().grid.origin[k] + node[k] * s.pairs().grid.edge[k];
      for (int k = 0; k < D; ++k) e[D * n + k] = field(x, k);
    }
    for (Index k = 0; k < u.size(); ++k) u[k] = field(s.particles.position[k / D], static_cast<int>(k % D));
    const double expected = u.dot(inertia.cwiseProduct(u)) + viscousGalerkinFactor * u.dot(viscosity * u),
                 energy = e.dot(grid * e);
    EXPECT_NEAR(energy, expected, operatorTolerance * expected);
  }
}

TEST(HatGrid, ViscousGalerkinOperatorIsExactForLinearVelocities) {
  checkViscousGalerkin<2>();
  checkViscousGalerkin<3>();
}

/// M by its action on unit vectors.
template <int D, class T>
Matrix preconditioner(Parts<D, T>& parts, const ProjectionDegrees& degrees) {
  Scene<D>& s = parts.s;
  ProjectedMultigrid<D, T> m;
  m.setup(s.context, s.pairs(), s.terms(), parts.a, degrees);
  return denseOf(s.unknowns(), [&](const Vector& r) {
    std::vector<Vec<D>> z(s.n());
    m.apply(s.context, unflat<D>(r), z);
    return flat<D>(z);
  });
}

template <int D, class T>
void checkPreconditioner(Scene<D> scene, const ProjectionDegrees& degrees, double tolerance) {
  SCOPED_TRACE(testing::Message() << D << " dimensions, " << sizeof(T) << " bytes, pressure degree "
                                  << degrees.pressure);
  Parts<D, T> parts(std::move(scene));
  const Matrix m = preconditioner(parts, degrees);
  EXPECT_LT((m - m.transpose()).norm(), tolerance * m.norm());
  const Matrix symmetric = (m + m.transpose()) / 2;
  EXPECT_GT(eigenvalues(symmetric)[0], 0) << "not positive definite";
  const Vector product = eigenvaluesOfProduct(symmetric, Oracle<D>(parts.s).matrix());
  EXPECT_GT(product.minCoeff(), 0.4);
  EXPECT_LT(product.maxCoeff(), 3.5);
}

template <class T>
void checkPreconditioners(double tolerance) {
  constexpr bool isSingle = std::is_same_v<T, float>;  // only then the products know of slip
  for (const auto& [walls, scheme] : scenes) {
    checkPreconditioner<2, T>(makeScene<2>({.walls = walls, .scheme = scheme, .slips = isSingle}), {9, 4, 2},
                              tolerance);
    checkPreconditioner<3, T>(makeScene<3>({.walls = walls, .scheme = scheme, .slips = isSingle}), {9, 4, 2},
                              tolerance);
  }
  checkPreconditioner<2, T>(bodyIn<2>(11, true, Walls::Floor), {16, 3, 3}, tolerance);
  checkPreconditioner<2, T>(bodyIn<2>(16, false, Walls::None), {16, 3, 1}, tolerance);
}

TEST(ProjectedMultigrid, IsSymmetricPositiveDefiniteAndNearTheInverseInDouble) {
  checkPreconditioners<double>(2e-12);  // measured: 3e-13
}

TEST(ProjectedMultigrid, IsSymmetricPositiveDefiniteAndNearTheInverseInSingle) {
  checkPreconditioners<float>(1e-4);
}

}  // namespace
}  // namespace treacle::test
