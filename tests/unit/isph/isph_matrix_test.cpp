#include "support/isph_oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <class T>
constexpr double toleranceOf = std::is_same_v<T, double> ? operatorTolerance : singleTolerance;

Vector applied(const auto& product, const Vector& x) {
  Vector y = Vector::Constant(x.size(), NAN);
  product(std::span<const double>(x), std::span<double>(y));
  return y;
}

/// A matrix of pairs against the one by the paper's formulas.
template <int D, class T, class Row>
void checkMatrix(IsphScene<D>& s, const Row& row, const Matrix& expected) {
  SCOPED_TRACE(testing::Message() << D << "D, " << (sizeof(T) == 4 ? "single" : "double"));
  const IsphTestSystem<D, T> system(s, row);
  const IsphMatrix<T>& a = system.a;
  const Matrix found = dense(a);
  EXPECT_LE((found - expected).norm(), toleranceOf<T> * expected.norm());
  EXPECT_EQ((found - found.transpose()).norm(), 0) << "not symmetric to the last bit";

  // Rows sum up to what the diagonal holds beyond pairs of unknowns, in single precision, too.
  const Vector known = expected.rowSums();
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    ASSERT_NEAR(found.row(i).sum(), known[i], operatorTolerance * expected(i, i));
    ASSERT_NEAR(system.moments[i].own, known[i], singleTolerance * expected(i, i));
  }
  // Half the sum of c d d^T.
  const IsphOracle<D> oracle(s);
  for (std::uint32_t i = 0; i < s.n(); i += 3) {
    Block<D> m{};
    for (std::uint32_t j = 0; j < s.n(); ++j) {
      if (j == i) continue;
      const Vec<D> d = oracle.apart(i, j);
      m.addOuter(-0.5 * expected(i, j), d, d);
    }
    double square = 0;
    for (const double e : m.a) square += e * e;
    for (int p = 0; p < D; ++p)
      for (int q = 0; q < D; ++q) {
        Vec<D, float> ep{}, eq{};
        ep[p] = eq[q] = 1;
        ASSERT_NEAR(system.moments[i].between(ep, eq), m(p, q), singleTolerance * (std::sqrt(square) + 1e-30));
      }
  }

  const Vector x = randomVector(s.n(), 3);
  const auto whole = [&](auto from, auto to) { multiply(s.context, a, from, to); };
  EXPECT_LE((applied(whole, x) - found * x).norm(), operatorTolerance * (found * x).norm());
  const Vector inverse = found.diagonal().cwiseInverseOrZero();
  const auto scaled = [&](auto from, auto to) { jacobi(s.context, a, from, to); };
  EXPECT_LE((applied(scaled, x) - inverse.cwiseProduct(x)).norm(), operatorTolerance * inverse.norm());

  BlockCsr<1> csr;
  compressed(s.context, a, a.rows, csr);
  EXPECT_EQ((dense(csr) - found).norm(), 0);
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    EXPECT_TRUE(std::is_sorted(csr.column.begin() + csr.rowStart[i], csr.column.begin() + csr.rowStart[i + 1]));
    EXPECT_EQ(csr.rowStart[i] == csr.rowStart[i + 1], expected(i, i) == 0) << "rows of zeros are empty";
  }
}

template <int D>
void checkMatrices() {
  for (const Walls walls : {Walls::Floor, Walls::None})
    for (const WallSlip slip : {WallSlip::NoSlip, WallSlip::FreeSlip}) {
      IsphScene<D> s = makeIsphScene<D>(walls, 0.2);
      s.c.method.isph.walls = slip;
      s.pairs.noSlip = slip == WallSlip::NoSlip;
      ASSERT_GT(s.surfaceCount(), 0u);
      ASSERT_LT(s.surfaceCount(), s.n());
      const IsphOracle<D> oracle(s);
      const PressureRow<D> pressure{s.surface.data()};
      const Matrix p = oracle.pressureMatrix([&](std::uint32_t i) { return s.surface[i] != Place::Free; });
      checkMatrix<D, double>(s, pressure, p);
      checkMatrix<D, float>(s, pressure, p);
      const Matrix v = oracle.viscousMatrix();
      checkMatrix<D, double>(s, ViscousRow<D>{}, v);
      checkMatrix<D, float>(s, ViscousRow<D>{}, v);
    }
}

TEST(IsphMatrix, IsThatOfThePapersFormulas) {
  checkMatrices<2>();
  checkMatrices<3>();
}

/// The smoothers' matrix: near pairs alone, in whole units, and a diagonal that belongs to them.
template <int D>
Matrix cutMatrix(const IsphScene<D>& s, const Matrix& whole, double unit) {
  const IsphOracle<D> oracle(s);
  Matrix cut = Matrix::Zero(s.n(), s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    cut(i, i) = whole.row(i).sum();
    for (std::uint32_t j = 0; j < s.n(); ++j) {
      if (j == i || norm(oracle.apart(i, j)) >= 0.79 * 2.4 * s.c.spacing) continue;
      cut(i, j) = -unit * std::floor(-whole(i, j) / unit + 0.5);
      cut(i, i) -= cut(i, j);
    }
  }
  return cut;
}

template <int D, class T, class Row>
void checkSweeps(IsphScene<D>& s, const Row& row) {
  const IsphTestSystem<D, T> system(s, row);
  const Matrix cut = cutMatrix(s, dense(system.a), system.a.unit);
  EXPECT_EQ((cut - cut.transpose()).norm(), 0);
  EXPECT_LE((cut - dense(system.a)).norm(), 0.2 * cut.norm());
  const Vector r = randomVector(s.n(), 1), start = randomVector(s.n(), 2);
  std::vector<T> from(start.begin(), start.end());
  Vector x(s.n()), unknown(s.n());
  Vector inverse(s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    unknown[i] = row.isUnknown(i), x[i] = from[i];
    if (row.isUnknown(i)) inverse[i] = 1 / cut(i, i);
  }
  const Vector residual = unknown.cwiseProduct(r - cut * x);
  const Vector swept = unknown.cwiseProduct(x + inverse.cwiseProduct(residual));

  const std::span<const double> rs(r.data(), s.n());
  std::vector<T> out(s.n(), NAN);
  std::vector<double> outDouble(s.n(), NAN);
  firstSweep<T>(s.context, system.a, rs, out);
  EXPECT_LE((Vector(out) - inverse.cwiseProduct(r)).norm(), toleranceOf<T> * inverse.norm());
  nearResidual<T>(s.context, system.a, rs, from, out);
  EXPECT_LE((Vector(out) - residual).norm(), toleranceOf<T> * residual.norm());
  lastSweep<T>(s.context, system.a, rs, from, outDouble);
  EXPECT_LE((Vector(outDouble) - swept).norm(), toleranceOf<T> * x.norm());
}

template <int D>
void checkAllSweeps() {
  for (const Walls walls : {Walls::Floor, Walls::None}) {
    IsphScene<D> s = makeIsphScene<D>(walls, 0.2);
    checkSweeps<D, double>(s, PressureRow<D>{s.surface.data()});
    checkSweeps<D, float>(s, PressureRow<D>{s.surface.data()});
    checkSweeps<D, double>(s, ViscousRow<D>{});
  }
}

TEST(IsphMatrix, SmoothersTakeNearPairsInWholeUnits) {
  checkAllSweeps<2>();
  checkAllSweeps<3>();
}

TEST(PackedEntry, HoldsPlacesAndTwentyOneBitsOfCoefficients) {
  const double unit = 0.37, end = 255 * unit;
  for (std::uint32_t n = 0; n <= 2000; ++n) {
    const double c = end * n / 2000;
    const std::uint32_t place = n * 7919u % ColumnBlocksView::columns;
    const std::uint32_t word = PackedEntry::word(place, c, unit);
    ASSERT_EQ(PackedEntry::place(word), place);
    ASSERT_NEAR(unit / 8192 * PackedEntry::value(word), c, 0.5001 / 8192 * unit);
    // What rounds twice may be half a part farther from a whole unit.
    ASSERT_NEAR(PackedEntry::whole(word) * unit, c, (0.5 + 0.51 / 8192) * unit);
  }
  EXPECT_EQ(PackedEntry::value(PackedEntry::word(5, 0, unit)), 0u);
}

TEST(IsphMatrix, OfNobody) {
  Case c = waterCase(2, {10, 10, 0});
  IsphScene<2> s(c, particlesAt<2>({}, {{0.05, 0.05}}));
  const IsphTestSystem<2, double> system(s, PressureRow<2>{s.surface.data()});
  BlockCsr<1> csr;
  compressed(s.context, system.a, system.a.rows, csr);
  EXPECT_EQ(csr.rows(), 0u);
}

}  // namespace
}  // namespace treacle::test
