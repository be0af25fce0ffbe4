#include "support/oracle.hpp"

#include <algorithm>
#include <cmath>

namespace treacle::test {

namespace {

/// S of a weight l^d / (S h^d) f(r/h).
template <int D>
double integralOf(WeightShape shape) {
  switch (shape) {
    case WeightShape::Published:
      return D == 2 ? M_PI / 6 : 2 * M_PI / 15;
    case WeightShape::Wendland:
      return D == 2 ? M_PI / 7 : 2 * M_PI / 21;
    case WeightShape::DensityWindow:
      return DensityWindow::integral<D>();
    case WeightShape::GradientWindow:
      return GradientWindow::integral<D>();
  }
  return 0;
}

}  // namespace

/// Windows have a test of their own.
template <int D>
double Oracle<D>::dw(double r, double h) const {
  const double q = r / h;
  if (q > 1) return 0;
  const double slope = s.c.isAccurate() ? -2 * q * GradientWindow::slope<double>(1 - q * q) : -2 * (1 - q);
  return slopeScale * std::pow(l / h, D) / integralOf<D>(gradientWeight(s.c.method.scheme)) * slope / h;
}

template <int D>
double Oracle<D>::densityWeight(double r) const {
  const double q = r / hn;
  if (q > 1) return 0;
  const auto weight = [&](WeightShape shape, double f) { return std::pow(l / hn, D) / integralOf<D>(shape) * f; };
  if (s.c.keepsVolume()) return weight(WeightShape::DensityWindow, DensityWindow::at(1 - q * q));
  if (s.c.isAccurate()) return weight(WeightShape::Wendland, std::pow(1 - q, 4) * (4 * q + 1));
  return weight(WeightShape::Published, std::pow(1 - q, 2));
}

/// With the weight of [K23] what its eq. (4) makes of it. For c = A f(r/h) / r^2 a full neighbourhood has the
/// viscosity 1 where the integral of c r^4 is 2 D (D + 2) l^D; `moment` is the integral of f(q) q^(D+1) from 0
/// to 1.
template <int D>
double Oracle<D>::viscousBlock(double r) const {
  const double q = r / hv;
  if (q > 1) return 0;
  if (!s.c.isAccurate()) {
    const double integral = D == 2 ? M_PI / 6 : 2 * M_PI / 15;
    return 4 * (D + 2) * std::pow(l / hv, D) / (integral * hv) * (1 - q) / std::pow(r, 3);
  }
  const double sphere = D == 2 ? 2 * M_PI : 4 * M_PI;
  const double moment = D == 2 ? 1.0 / 105 : 1.0 / 168;
  const double f = q * std::pow(1 - q, 2);
  return 2 * D * (D + 2) * std::pow(l, D) / (sphere * moment * std::pow(hv, D + 2)) * f / (r * r);
}

/// The viscous force of a pair that parts to 0.53 l in a step.
template <int D>
Vec<D> Oracle<D>::repulsion(std::uint32_t i, std::uint32_t j) const {
  const Vec<D> d = difference(i, j);
  const double r = norm(d), reach = s.c.method.scheme == SchemeKind::Accurate ? 0.53 * l : 0;
  if (i == j || r >= reach) return {};
  return -mu(i, j) * pairScale(i, j) * viscousBlock(r) * r * (reach - r) / dt * d;
}

template <int D>
double Oracle<D>::mu(std::uint32_t i, std::uint32_t j) const {
  const double a = material(i).dynamicViscosity, b = material(j).dynamicViscosity;
  return 2 * a * b / (a + b);
}

template <int D>
double Oracle<D>::viscosityScale(std::uint32_t i) const {
  double moment = 0;
  for (std::uint32_t j = 0; j < count(); ++j)
    if (j != i) moment += viscousBlock(norm(difference(i, j))) * std::pow(norm(difference(i, j)), 4);
  const double share = s.c.method.viscosityCorrection;
  return 1 - share + share * std::min(4.0, 2 * D * (D + 2) / moment);
}

template <int D>
double Oracle<D>::pairScale(std::uint32_t i, std::uint32_t j) const {
  const std::uint32_t fluid = s.particles.fluidCount;
  if (s.c.method.viscosityCorrection == 0 || (i >= fluid && j >= fluid)) return 1;
  if (scales.empty())
    for (std::uint32_t k = 0; k < fluid; ++k) scales.push_back(viscosityScale(k));
  if (i >= fluid) return scales[j];
  if (j >= fluid) return scales[i];
  return (scales[i] + scales[j]) / 2;
}

template <int D>
double Oracle<D>::wallFactor(std::uint32_t i, std::uint32_t j) const {
  const std::uint32_t fluid = s.particles.fluidCount;
  if (i >= fluid && j < fluid) return wallFactor(j, i);
  if (j < fluid || s.particles.wallSurface.empty()) return 1;
  const Face seen = face(i, j);
  const double held = std::max(seen.distance, l / 4);
  // The wall holds each fluid by the viscosity of this fluid.
  const double own = !s.c.hasOwnViscosities() ? mu(i, i) / mu(i, j) : 1;
  return own * (seen.depth > 0 ? (held + seen.depth) / (held + material(i).slipLength) : 1);
}

template <int D>
auto Oracle<D>::face(std::uint32_t i, std::uint32_t j) const -> Face {
  Face seen;
  double crossing = 0;  // where the line from i meets the face, as a share of its length
  for (const Vec<D, float>& face : s.particles.wallSurface[j - s.particles.fluidCount].face) {
    double depth = 0, distance = 0;
    for (int k = 0; k < D; ++k) depth += std::pow(face[k], 2);
    depth = std::sqrt(depth);
    if (depth == 0) continue;
    for (int k = 0; k < D; ++k) distance -= face[k] / depth * difference(i, j)[k];
    distance -= depth;
    const double share = distance / (distance + depth);
    if (seen.depth > 0 && (distance <= 0 || share <= crossing)) continue;
    crossing = distance > 0 ? share : 0;
    seen = {{}, depth, distance};
    for (int k = 0; k < D; ++k) seen.normal[k] = face[k] / depth;
  }
  return seen;
}

template <int D>
Vec<D> Oracle<D>::acting(std::uint32_t i, std::uint32_t j, const Vec<D>& v) const {
  const std::uint32_t fluid = s.particles.fluidCount;
  if (i >= fluid && j < fluid) return acting(j, i, v);
  if (i >= fluid || j < fluid || s.particles.wallSurface.empty() || material(i).slipLength == 0) return v;
  const Face seen = face(i, j);
  if (seen.depth == 0) return v;
  if (!sides.empty()) return v - sides[i].along(v);
  double across = 0;
  for (int k = 0; k < D; ++k) across += seen.normal[k] * v[k];
  return across * seen.normal;
}

template <int D>
void Oracle<D>::findSlipSides() {
  const std::uint32_t fluid = s.particles.fluidCount;
  for (std::uint32_t i = 0; i < fluid; ++i) {
    SymmetricBlock<D> normals{}, others{};
    const auto forEachWall = [&](auto&& f) {
      for (std::uint32_t j = fluid; j < count(); ++j)
        if (const double r = norm(difference(i, j)); r < hp) f(j, r);
    };
    forEachWall([&](std::uint32_t j, double r) {
      if (const Face seen = face(i, j); seen.depth > 0) normals.addOuter(-dw(r, hp), seen.normal);
    });
    const Vec<D> mean = mainAxis(normals);
    forEachWall([&](std::uint32_t j, double) {
      if (const Face seen = face(i, j); seen.depth > 0) others.addOuter(1, otherNormal(seen.normal, mean));
      const auto& faces = s.particles.wallSurface[j - fluid].face;
      const Vec<D> a = converted<double>(faces[0]), b = converted<double>(faces[1]);
      if (norm(a) == 0 || norm(b) == 0 || norm(a) > 1.25 * l || norm(b) > 1.25 * l) return;
      for (const Vec<D>& way : {a, b}) others.addOuter(1, otherNormal((1 / norm(way)) * way, mean));
    });
    sides.push_back(slipSideOf(mean, others));
  }
}

template <int D>
Vec<D> Oracle<D>::difference(std::uint32_t i, std::uint32_t j) const {
  Vec<D> d;
  for (int k = 0; k < D; ++k) {
    d[k] = s.particles.position[j][k] - s.particles.position[i][k];
    const double length = s.c.domain.max[k] - s.c.domain.min[k];
    if (s.c.domain.periodic[k]) d[k] -= length * std::round(d[k] / length);
  }
  return d;
}

template <int D>
double Oracle<D>::numberDensity(std::uint32_t i) const {
  double n = 0;
  for (std::uint32_t j = 0; j < count(); ++j)
    if (j != i) n += densityWeight(norm(difference(i, j)));
  return n;
}

template <int D>
double Oracle<D>::latticeMoment() const {
  const int reach = static_cast<int>(std::ceil(hp / l)), side = 2 * reach + 1;
  double sum = 0;
  for (int place = 0; place < std::pow(side, D); ++place) {
    double square = 0;
    for (int k = 0, rest = place; k < D; ++k, rest /= side) square += std::pow(rest % side - reach, 2);
    if (square > 0) sum -= dw(l * std::sqrt(square), hp) * l * std::sqrt(square) / D;
  }
  return sum;
}

template <int D>
Matrix Oracle<D>::moment(std::uint32_t i, bool acts) const {
  Matrix m = Matrix::Zero(D, D);
  for (std::uint32_t j = 0; j < count(); ++j) {
    if (j == i) continue;
    const Vec<D> d = difference(i, j), v = acts ? acting(i, j, d) : d;
    for (int r = 0; r < D; ++r)
      for (int k = 0; k < D; ++k) m(r, k) -= dw(norm(d), hp) / norm(d) * v[r] * v[k];
  }
  return m;
}

template <int D>
Matrix Oracle<D>::renormalisation(std::uint32_t i) const {
  if (!s.c.isAccurate() || i >= s.particles.fluidCount) return Matrix::Identity(D, D);
  return renormalisationOracle(moment(i), moment(i, true));
}

Matrix renormalisationOracle(const Matrix& whole, const Matrix& acting) {
  const double factor = std::min(1.0, std::max(eigenSystem(whole).values.minCoeff(), 0.3));
  const EigenSystem system = eigenSystem(acting);
  const Index n = acting.rows();
  Matrix b = Matrix::Zero(n, n);
  for (Index k = 0; k < n; ++k)
    for (Index r = 0; r < n; ++r)
      for (Index c = 0; c < n; ++c)
        b(r, c) +=
            factor * system.vectors(r, k) * system.vectors(c, k) / std::max({system.values[k], 0.3, 0.5 * factor});
  return b;
}

template <int D>
double Oracle<D>::dissipation(const Vector& u, const std::function<Matrix(std::uint32_t)>& factor,
                              const std::function<double(std::uint32_t)>& lambda) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < count(); ++i) {
    double divergence = 0;
    const Matrix b = factor(i);
    for (std::uint32_t j = 0; j < count(); ++j) {
      if (j == i) continue;
      const Vec<D> d = difference(i, j);
      const double r = norm(d);
      if (r > std::max(hp, hv)) continue;
      double along = 0;
      for (int k = 0; k < D; ++k) along += (u[D * j + k] - u[D * i + k]) * d[k] / r;
      const Vec<D> column = acting(i, j, times(b, d));
      for (int k = 0; k < D; ++k) divergence += (u[D * j + k] - u[D * i + k]) * column[k] / r * dw(r, hp);
      if (j > i)
        sum += mu(i, j) * pairScale(i, j) * wallFactor(i, j) / 2 * viscousBlock(r) * r * r * along * along;
    }
    sum += lambda(i) / 2 * divergence * divergence;
  }
  return sum * std::pow(l, D);
}

template <int D>
Matrix Oracle<D>::gradientMatrix(double reach) const {
  const Index n = s.unknowns();
  Matrix c = Matrix::Zero(n, count());
  std::vector<Matrix> b;
  for (std::uint32_t j = 0; j < count(); ++j) b.push_back(renormalisation(j));
  for (std::uint32_t i = 0; i < s.n(); ++i)
    for (std::uint32_t j = 0; j < count(); ++j) {
      if (j == i) continue;
      const Vec<D> d = difference(i, j);
      if (norm(d) >= reach * hp) continue;
      const Vec<D> g = -dw(norm(d), hp) / norm(d) * d;
      const Vec<D> ofOther = acting(i, j, times(b[j], g)), ofOwn = acting(i, j, times(b[i], g));
      for (int k = 0; k < D; ++k) c(D * i + k, j) += ofOther[k], c(D * i + k, i) += ofOwn[k];
    }
  return c;
}

template <int D>
Matrix Oracle<D>::viscosityMatrix() const {
  Matrix v = Matrix::Zero(s.unknowns(), s.unknowns());
  for (std::uint32_t i = 0; i < s.n(); ++i)
    for (std::uint32_t j = 0; j < count(); ++j) {
      if (j == i) continue;
      const Vec<D> d = difference(i, j);
      const double r = norm(d);
      Block<D> block{};
      block.addOuter(mu(i, j) * pairScale(i, j) * wallFactor(i, j) * viscousBlock(r), d, d);
      for (int k = 0; k < D; ++k)
        for (int m = 0; m < D; ++m) {
          v(D * i + k, D * i + m) += block(k, m);
          if (j < s.n()) v(D * i + k, D * j + m) -= block(k, m);
        }
    }
  return v;
}

template <int D>
double Oracle<D>::restDensity() const {
  const int reach = static_cast<int>(std::ceil(hn / l)), side = 2 * reach + 1;
  double n = -densityWeight(0);
  for (int place = 0; place < std::pow(side, D); ++place) {
    double square = 0;
    for (int k = 0, rest = place; k < D; ++k, rest /= side) square += std::pow(rest % side - reach, 2);
    n += densityWeight(l * std::sqrt(square));
  }
  return n;
}

template <int D>
Vector Oracle<D>::elasticPressure() const {
  const double rest = restDensity();
  Vector p(count());
  for (std::uint32_t i = 0; i < count(); ++i)
    p[i] = material(i).bulkModulus * std::max(0.0, numberDensity(i) - rest);
  return p;
}

template <int D>
Vector Oracle<D>::rightHandSide() const {
  Vector b = -(gradientMatrix() * elasticPressure());
  for (Index k = 0; k < b.size(); ++k)
    b[k] += material(k / D).density * (s.particles.velocity[k / D][k % D] / dt + s.c.gravity[k % D]);
  for (std::uint32_t i = 0; i < s.n(); ++i)
    for (std::uint32_t j = 0; j < count(); ++j) {
      const Vec<D> force = repulsion(i, j);
      for (int k = 0; k < D; ++k) b[D * i + k] += force[k];
    }
  return b;
}

template <int D>
Matrix Oracle<D>::matrix() const {
  Vector inertia(s.unknowns()), lambda(count());
  for (Index i = 0; i < s.unknowns(); ++i) inertia[i] = material(i / D).density / dt;
  for (std::uint32_t i = 0; i < count(); ++i) lambda[i] = bulkViscosity(i);
  const Matrix c = gradientMatrix();
  Matrix a = viscosityMatrix() + c * lambda.asDiagonal() * c.transpose();
  a.addToDiagonal(inertia);
  return a;
}

template <int D>
Vector applyOperator(Scene<D>& s, MphOperator<D>& a, const Vector& x) {
  const std::vector<Vec<D>> u = unflat<D>(x);
  std::vector<Vec<D>> y(u.size());
  a.multiply(s.context, u, y);
  return flat<D>(y);
}

template struct Oracle<2>;
template Vector applyOperator(Scene<2>&, MphOperator<2>&, const Vector&);
template struct Oracle<3>;
template Vector applyOperator(Scene<3>&, MphOperator<3>&, const Vector&);

}  // namespace treacle::test
