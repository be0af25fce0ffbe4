#include "support/isph_oracle.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace treacle::test {

template <int D>
double IsphOracle<D>::mu(std::uint32_t i, std::uint32_t j) const {
  const double a = material(isWall(i) ? j : i).dynamicViscosity, b = material(isWall(j) ? i : j).dynamicViscosity;
  return 2 * a * b / (a + b);
}

template <int D>
double IsphOracle<D>::kernel(double r) const {
  const double q = r / h;
  if (q >= 2) return 0;
  if (s.c.method.isph.kernel == KernelKind::WendlandC2)
    return (D == 2 ? 7 / (4 * M_PI * h * h) : 21 / (16 * M_PI * h * h * h)) * std::pow(1 - q / 2, 4) * (1 + 2 * q);
  const double sigma = D == 2 ? 10 / (7 * M_PI * h * h) : 1 / (M_PI * h * h * h);
  return sigma * (q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : 0.25 * std::pow(2 - q, 3));
}

template <int D>
double IsphOracle<D>::kernelSlope(double r) const {
  const double q = r / h;
  if (q >= 2) return 0;
  if (s.c.method.isph.kernel == KernelKind::WendlandC2)
    return (D == 2 ? 7 / (4 * M_PI * h * h) : 21 / (16 * M_PI * h * h * h)) * -5 * q * std::pow(1 - q / 2, 3) / h;
  const double sigma = D == 2 ? 10 / (7 * M_PI * h * h) : 1 / (M_PI * h * h * h);
  return sigma / h * (q < 1 ? -3 * q + 2.25 * q * q : -0.75 * std::pow(2 - q, 2));
}

template <int D>
Vec<D> IsphOracle<D>::apart(std::uint32_t i, std::uint32_t j) const {
  Vec<D> d = s.particles.position[i] - s.particles.position[j];
  for (int k = 0; k < D; ++k) {
    const double length = s.c.domain.max[k] - s.c.domain.min[k];
    if (s.c.domain.periodic[k]) d[k] -= length * std::round(d[k] / length);
  }
  return d;
}

template <int D>
Vec<D> IsphOracle<D>::gradient(std::uint32_t i, std::uint32_t j) const {
  const Vec<D> r = apart(i, j);
  return (volume * kernelSlope(norm(r)) / norm(r)) * r;
}

template <int D>
double IsphOracle<D>::laplacian(std::uint32_t i, std::uint32_t j) const {
  return dot(apart(i, j), gradient(i, j)) / norm2(apart(i, j));
}

template <int D>
double IsphOracle<D>::latticeLaplacian() const {
  double sum = 0;
  for (const Vec<D>& x : latticeAt<D>(Vec<D>::filled(-3 * l), Vec<D, int>::filled(7), l))
    if (norm(x) > 0.5 * l) sum -= 2 * volume * kernelSlope(norm(x)) / norm(x);
  return sum;
}

template <int D>
double IsphOracle<D>::density(std::uint32_t i) const {
  const double radius = 2 * s.c.smoothingLength();
  const auto weight = [&](double r) {
    if (!isAccurate()) return kernel(r);
    return r < radius ? RowWindow::at(1 - r * r / (radius * radius)) : 0;
  };
  double lattice = 0, sum = weight(0);
  for (const Vec<D>& x : latticeAt<D>(Vec<D>::filled(-4 * l), Vec<D, int>::filled(9), l))
    lattice += weight(norm(x));
  forEachOther(i, [&](std::uint32_t j) { sum += weight(norm(apart(i, j))); });
  return sum / lattice;
}

template <int D>
Vec<D> IsphOracle<D>::deficit(std::uint32_t i) const {
  Vec<D> sum{};
  forEachOther(i, [&](std::uint32_t j) { sum += gradient(i, j); });
  return sum;
}

template <int D>
std::optional<typename IsphOracle<D>::Face> IsphOracle<D>::face(std::uint32_t i, std::uint32_t j) const {
  if (!isAccurate() || s.particles.wallSurface.empty()) return {};
  std::optional<Face> last;
  for (const Vec<D, float>& way : s.particles.wallSurface[j - s.n()].face) {
    const double depth = norm(converted<double>(way));
    if (depth == 0) continue;
    const Vec<D> normal = (1 / depth) * converted<double>(way);
    const Face other{normal, dot(apart(i, j), normal) - depth, depth};
    if (!last || (other.height > 0 && other.height / depth > last->height / last->depth)) last = other;
  }
  return last;
}

template <int D>
double IsphOracle<D>::wallFactor(std::uint32_t i, std::uint32_t j) const {
  const auto at = face(i, j);
  if (!at) return 2;
  const double height = std::max(at->height, 0.25 * l);
  return (height + at->depth) / height;
}

template <int D>
Matrix IsphOracle<D>::inverseMoment(std::uint32_t i, WallPart walls) const {
  Eigen::Matrix<double, D, D> m = Eigen::Matrix<double, D, D>::Zero();
  forEachOther(i, [&](std::uint32_t j) {
    if (isWall(j) && walls == WallPart::None) return;
    Vec<D> g = gradient(i, j), d = apart(i, j);
    if (const auto at = isWall(j) && walls == WallPart::Across ? face(i, j) : std::nullopt)
      g = dot(g, at->normal) * at->normal, d = dot(d, at->normal) * at->normal;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) m(a, b) -= g[a] * d[b];
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver(m);
  const auto& v = solver.eigenvectors();
  const Eigen::Matrix<double, D, D> inverse =
      v * solver.eigenvalues().cwiseMax(0.3).cwiseInverse().asDiagonal() * v.transpose();
  Matrix b = Matrix::Zero(D, D);
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) b(r, c) = inverse(r, c);
  return b;
}

template <int D>
Matrix IsphOracle<D>::renormalisation(std::uint32_t i) const {
  return isAccurate() ? inverseMoment(i, WallPart::Whole) : Matrix(Matrix::Identity(D, D));
}

template <int D>
Matrix IsphOracle<D>::derivative(std::uint32_t i) const {
  return isAccurate() ? inverseMoment(i, WallPart::Across) : Matrix(Matrix::Identity(D, D));
}

template <int D>
Vec<D> IsphOracle<D>::renormalised(std::uint32_t i, const Vec<D>& x) const {
  return times(renormalisation(i), x);
}

template <int D>
double IsphOracle<D>::along(std::uint32_t i, std::uint32_t j) const {
  const Vec<D> e = (1 / norm(apart(i, j))) * apart(i, j);
  return dot(e, renormalised(i, e));
}

template <int D>
double IsphOracle<D>::missing(std::uint32_t i) const {
  if (!isAccurate()) return 0;
  double found = 0;
  forEachOther(i, [&](std::uint32_t j) { found -= 2 * laplacian(i, j); });
  const double share = 1 - found / latticeLaplacian(), lack = norm(deficit(i)) * l;
  const double weight = std::clamp(std::max((lack - 0.05) / 0.1, (share - 0.15) / 0.1), 0.0, 1.0);
  return weight * std::max(0.0, share);
}

template <int D>
Vec<D> IsphOracle<D>::onSurface(const std::vector<Vec<D>>& v, std::uint32_t i, std::uint32_t j) const {
  const auto at = face(i, j);
  if (!at || motion.empty()) return v[j];
  const Vec<3> omega = motion[s.particles.body[j]].spin;
  const Vec<3> way = resized<3>((at->depth / (at->depth + std::max(at->height, 0.0))) * apart(i, j));
  return v[j] + resized<D>(cross(omega, way));
}

template <int D>
Vec<D> IsphOracle<D>::seen(const std::vector<Vec<D>>& v, std::uint32_t i, std::uint32_t j) const {
  return isWall(j) ? 2.0 * v[j] - v[i] : v[j];
}

template <int D>
Vec<D> IsphOracle<D>::predicted(const std::vector<Vec<D>>& v, std::uint32_t i) const {
  Vec<D> force = material(i).density * resized<D>(s.c.gravity);
  forEachOther(i, [&](std::uint32_t j) {
    if (isWall(j) && s.c.method.isph.walls == WallSlip::FreeSlip) return;
    const Vec<D> relative = isWall(j) ? wallFactor(i, j) * (v[i] - onSurface(v, i, j)) : v[i] - v[j];
    force += (2 * laplacian(i, j) * mu(i, j)) * relative;
  });
  return v[i] + (dt / material(i).density) * force;
}

template <int D>
double IsphOracle<D>::divergence(const std::vector<Vec<D>>& v, std::uint32_t i) const {
  double sum = 0;
  forEachOther(i, [&](std::uint32_t j) {
    const Vec<D> relative = seen(v, i, j) - v[i];
    sum += isWall(j) ? along(i, j) * dot(relative, gradient(i, j))
                     : dot(relative, times(derivative(i), gradient(i, j)));
  });
  return sum;
}

template <int D>
Matrix IsphOracle<D>::velocityGradient(const std::vector<Vec<D>>& v, std::uint32_t i) const {
  Matrix sum = Matrix::Zero(D, D);
  const Matrix inverse = inverseMoment(i, WallPart::None);
  forEachOther(i, [&](std::uint32_t j) {
    if (isWall(j)) return;
    const Vec<D> g = times(inverse, gradient(i, j));
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) sum(a, b) += (v[j][a] - v[i][a]) * g[b];
  });
  return sum;
}

template <int D>
Vec<D> IsphOracle<D>::transposedForce(const std::vector<Vec<D>>& v, std::uint32_t i) const {
  const Matrix own = velocityGradient(v, i);
  Vec<D> sum{};
  forEachOther(i, [&](std::uint32_t j) {
    const Matrix both = own + (isWall(j) ? own : velocityGradient(v, j));
    const Vec<D> g = mu(i, j) * gradient(i, j);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) sum[b] += both(a, b) * g[a];
  });
  return sum;
}

template <int D>
Vec<D> IsphOracle<D>::damped(const std::vector<Vec<D>>& v, const std::vector<double>& p, std::uint32_t i) const {
  const Matrix own = velocityGradient(v, i);
  const auto speed = [&](std::uint32_t k) { return std::sqrt(std::abs(p[k]) / material(k).density); };
  Vec<D> sum{};
  forEachOther(i, [&](std::uint32_t j) {
    if (isWall(j)) return;
    const Vec<D> e = (1 / norm(apart(i, j))) * apart(i, j);
    const Matrix both = own + velocityGradient(v, j);
    double jump = dot(v[j] - v[i], e);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) jump += 0.5 * both(a, b) * e[a] * apart(i, j)[b];
    const double light = 2 * material(j).density / (material(i).density + material(j).density);
    const double part = std::min(0.5, 0.5 * (speed(i) + speed(j)) * dt / l);
    sum += (-2 * laplacian(i, j) / latticeLaplacian() * light * part * jump) * e;
  });
  return v[i] + sum;
}

template <int D>
double IsphOracle<D>::flowSource(const std::vector<Vec<D>>& v, std::uint32_t i) const {
  return (missing(i) - 1) * divergence(v, i) / dt;
}

template <int D>
double IsphOracle<D>::densitySource(std::uint32_t i) const {
  const double share = missing(i), lack = share > 0 ? std::min(0.0, 1 - density(i)) : 1 - density(i);
  return (share - 1) * s.c.method.isph.alpha * lack / (dt * dt);
}

template <int D>
double IsphOracle<D>::inWall(double p, std::uint32_t i, std::uint32_t j,
                             const std::vector<Vec<D>>& acceleration) const {
  const Vec<D> pull = resized<D>(s.c.gravity) - acceleration[j];
  const double carried = p - material(i).density * dot(pull, apart(i, j));
  return s.c.method.isph.negativePressure ? carried : std::max(0.0, carried);
}

template <int D>
Vec<D> IsphOracle<D>::corrected(const std::vector<Vec<D>>& v, const std::vector<double>& p, std::uint32_t i,
                                const std::vector<Vec<D>>& acceleration) const {
  Vec<D> sum{};
  forEachOther(i, [&](std::uint32_t j) {
    const Vec<D> g = gradient(i, j), own = renormalised(i, g);
    sum += p[i] * own + (isWall(j) ? inWall(p[i], i, j, acceleration) * own : p[j] * renormalised(j, g));
  });
  return v[i] - (dt / material(i).density) * sum;
}

template <int D>
Vec<D> IsphOracle<D>::stopped(const Vec<D>& moving, const std::vector<Vec<D>>& v, double p,
                              std::uint32_t i) const {
  double touching = 0, full = 0, share = 0, weights = 0;
  for (const Vec<D>& x : latticeAt<D>(Vec<D>::filled(-3 * l), Vec<D, int>::filled(7), l)) {
    full += volume * kernel(norm(x));
    if (x[D - 1] < -0.5 * l) touching += volume * kernel(norm(x));
  }
  Vec<D> towards{}, mean{};
  forEachOther(i, [&](std::uint32_t j) {
    if (!isWall(j)) return;
    share += volume * kernel(norm(apart(i, j))) / full;
    towards += gradient(i, j);
    mean += laplacian(i, j) * v[j];
    weights += laplacian(i, j);
  });
  if (share <= (p > 0 ? 0.35 : 1.001 * touching / full)) return moving;
  const Vec<D> normal = (1 / norm(towards)) * towards;
  const double away = share > 0.6 ? 0.02 * l / dt : 0;
  return moving - std::max(0.0, dot(moving - (1 / weights) * mean, normal) + away) * normal;
}

template <int D>
double IsphOracle<D>::wallPressure(const std::vector<double>& p, std::uint32_t wall,
                                   const std::vector<Vec<D>>& acceleration) const {
  double sum = 0, weights = 0;
  forEachOther(wall, [&](std::uint32_t i) {
    if (isWall(i)) return;
    sum += kernel(norm(apart(i, wall))) * inWall(p[i], i, wall, acceleration);
    weights += kernel(norm(apart(i, wall)));
  });
  return weights > 0 ? sum / weights : 0;
}

template <int D>
Matrix IsphOracle<D>::pressureMatrix(const std::function<bool(std::uint32_t)>& unknown) const {
  Matrix a = Matrix::Zero(s.n(), s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    if (!unknown(i)) continue;
    a(i, i) = missing(i) * latticeLaplacian() / material(i).density;
    forEachOther(i, [&](std::uint32_t j) {
      if (isWall(j)) return;
      const double c =
          -(along(i, j) + along(j, i)) * laplacian(i, j) / (0.5 * (material(i).density + material(j).density));
      a(i, i) += c;
      if (unknown(j)) a(i, j) -= c;
    });
  }
  return a;
}

template <int D>
Matrix IsphOracle<D>::viscousMatrix() const {
  Matrix a = Matrix::Zero(s.n(), s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    a(i, i) = material(i).density / dt;
    forEachOther(i, [&](std::uint32_t j) {
      const double c = -2 * laplacian(i, j) * mu(i, j);
      if (isWall(j)) {
        if (s.c.method.isph.walls == WallSlip::NoSlip) a(i, i) += wallFactor(i, j) * c;
      } else {
        a(i, i) += c;
        a(i, j) -= c;
      }
    });
  }
  return a;
}

template struct IsphOracle<2>;
template struct IsphOracle<3>;

}  // namespace treacle::test
