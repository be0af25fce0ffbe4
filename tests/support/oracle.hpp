#pragma once

#include "support/scene.hpp"

namespace treacle::test {

/// [K23] sect. 2 from its formulas, in the plainest way: all pairs, dense matrices, none of the program's own
/// formulas. Indices as in the scene: fluid first, then all walls.
template <int D>
struct Oracle {
  const Scene<D>& s;
  double l, hp, hv, dt;

  explicit Oracle(const Scene<D>& scene)
      : s(scene),
        l(s.c.spacing),
        hp(s.c.method.pressureRadius * l),
        hv(s.c.method.viscosityRadius * l),
        dt(s.c.time.step) {}

  std::uint32_t count() const { return s.particles.count; }
  const Material& material(std::uint32_t i) const { return s.c.materials[s.particles.material[i]]; }

  /// w and dw/dr of eq. (3), with l^d.
  double w(double r, double h) const {
    const double integral = D == 2 ? M_PI / 6 : 2 * M_PI / 15;
    return r > h ? 0 : std::pow(l, D) / (integral * std::pow(h, D)) * std::pow(1 - r / h, 2);
  }
  double dw(double r, double h) const {
    const double integral = D == 2 ? M_PI / 6 : 2 * M_PI / 15;
    return r > h ? 0 : -2 * std::pow(l, D) / (integral * std::pow(h, D + 1)) * (1 - r / h);
  }
  double mu(std::uint32_t i, std::uint32_t j) const {
    const double a = material(i).dynamicViscosity, b = material(j).dynamicViscosity;
    return 2 * a * b / (a + b);
  }
  /// Nearest periodic image of x_j - x_i.
  Eigen::Matrix<double, D, 1> difference(std::uint32_t i, std::uint32_t j) const {
    Eigen::Matrix<double, D, 1> d;
    for (int k = 0; k < D; ++k) {
      d[k] = s.particles.position[j][k] - s.particles.position[i][k];
      const double length = s.c.domain.max[k] - s.c.domain.min[k];
      if (s.c.domain.periodic[k]) d[k] -= length * std::round(d[k] / length);
    }
    return d;
  }

  double numberDensity(std::uint32_t i) const {
    double n = 0;
    for (std::uint32_t j = 0; j < count(); ++j)
      if (j != i) n += w(difference(i, j).norm(), hp);
    return n;
  }

  /// Rayleigh's dissipation function of eq. (10) for the velocities of all particles [W].
  double dissipation(const Eigen::VectorXd& u) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < count(); ++i) {
      double divergence = 0;
      for (std::uint32_t j = 0; j < count(); ++j) {
        if (j == i) continue;
        const Eigen::Matrix<double, D, 1> d = difference(i, j);
        const double r = d.norm();
        if (r > std::max(hp, hv)) continue;
        const double along = (u.template segment<D>(D * j) - u.template segment<D>(D * i)).dot(d / r);
        divergence += along * dw(r, hp);
        if (j > i) sum -= (D + 2) * mu(i, j) * along * along * dw(r, hv) / r;
      }
      sum += material(i).bulkViscosity / 2 * divergence * divergence;
    }
    return sum * std::pow(l, D);
  }

  /// C of physics: fluid unknowns by all particles.
  Eigen::MatrixXd gradientMatrix() const {
    const Eigen::Index n = s.unknowns();
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, count());
    for (std::uint32_t i = 0; i < s.n(); ++i)
      for (std::uint32_t j = 0; j < count(); ++j) {
        if (j == i) continue;
        const Eigen::Matrix<double, D, 1> d = difference(i, j);
        const Eigen::Matrix<double, D, 1> g = -d / d.norm() * dw(d.norm(), hp);
        c.template block<D, 1>(D * i, j) += g;
        c.template block<D, 1>(D * i, i) += g;
      }
    return c;
  }

  Eigen::MatrixXd viscosityMatrix() const {
    Eigen::MatrixXd v = Eigen::MatrixXd::Zero(s.unknowns(), s.unknowns());
    for (std::uint32_t i = 0; i < s.n(); ++i)
      for (std::uint32_t j = 0; j < count(); ++j) {
        if (j == i) continue;
        const Eigen::Matrix<double, D, 1> d = difference(i, j);
        const double r = d.norm();
        const Eigen::Matrix<double, D, D> block =
            -2 * (D + 2) * mu(i, j) * dw(r, hv) / (r * r * r) * d * d.transpose();
        v.template block<D, D>(D * i, D * i) += block;
        if (j < s.n()) v.template block<D, D>(D * i, D * j) -= block;
      }
    return v;
  }

  /// n_0: that of a particle in a full lattice.
  double restDensity() const {
    const int reach = static_cast<int>(std::ceil(hp / l)), side = 2 * reach + 1;
    double n = -w(0, hp);
    for (int place = 0; place < std::pow(side, D); ++place) {
      double square = 0;
      for (int k = 0, rest = place; k < D; ++k, rest /= side) square += std::pow(rest % side - reach, 2);
      n += w(l * std::sqrt(square), hp);
    }
    return n;
  }

  /// kappa [n - n_0]_+ of all particles [Pa].
  Eigen::VectorXd elasticPressure() const {
    const double rest = restDensity();
    Eigen::VectorXd p(count());
    for (std::uint32_t i = 0; i < count(); ++i)
      p[i] = material(i).bulkModulus * std::max(0.0, numberDensity(i) - rest);
    return p;
  }

  /// b of eq. (16) between walls at rest.
  Eigen::VectorXd rightHandSide() const {
    Eigen::VectorXd b = -(gradientMatrix() * elasticPressure());
    for (Eigen::Index k = 0; k < b.size(); ++k)
      b[k] += material(k / D).density * (s.particles.velocity[k / D][k % D] / dt + s.c.gravity[k % D]);
    return b;
  }

  /// A of eq. (16).
  Eigen::MatrixXd matrix() const {
    Eigen::VectorXd inertia(s.unknowns()), lambda(count());
    for (Eigen::Index i = 0; i < s.unknowns(); ++i) inertia[i] = material(i / D).density / dt;
    for (std::uint32_t i = 0; i < count(); ++i) lambda[i] = material(i).bulkViscosity;
    const Eigen::MatrixXd c = gradientMatrix();
    Eigen::MatrixXd a = viscosityMatrix() + c * lambda.asDiagonal() * c.transpose();
    a.diagonal() += inertia;
    return a;
  }
};

/// A of the scene by the matrix-free operator.
template <int D>
Eigen::VectorXd applyOperator(Scene<D>& s, MphOperator<D>& a, const Eigen::VectorXd& x) {
  const std::vector<Vec<D>> u = unflat<D>(x);
  std::vector<Vec<D>> y(u.size());
  a.multiply(s.context, u, y);
  return flat<D>(y);
}

}  // namespace treacle::test
