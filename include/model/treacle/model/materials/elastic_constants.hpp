#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/product.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/model/materials/elastic_mode.hpp"

#include <cmath>

namespace treacle {

/// An elastic mode for device code.
struct ElasticConstants {
  double modulus = 0;  // eta/lambda [Pa]; 0: there is no such mode
  double rate = 0;     // 1/lambda [1/s]
  double mobility = 0, extensibility = 0;
  bool exponential = false;

  static ElasticConstants of(const ElasticMode& m) {
    return {m.viscosity / m.relaxationTime, 1 / m.relaxationTime,
            m.model == ElasticModel::Giesekus ? m.mobility : 0,
            m.model == ElasticModel::LinearPtt || m.model == ElasticModel::ExponentialPtt ? m.extensibility : 0,
            m.model == ElasticModel::ExponentialPtt};
  }

  /// With `a` times its viscosity and relaxation time.
  TREACLE_HD ElasticConstants slowed(double a) const {
    ElasticConstants slow = *this;
    slow.rate /= a;
    return slow;
  }

  /// The viscosity that the step solves for with the flow [Pa s]: by how much the stress at the end of a step of
  /// dt [s] changes with the velocity gradient of that end. For long steps it is eta. The stress of a conformation
  /// that is stretched changes by as much more.
  TREACLE_HD double implicitViscosity(double dt) const { return -modulus / rate * std::expm1(-rate * dt); }
  template <int D>
  TREACLE_HD double implicitViscosity(double dt, const SymmetricBlock<D>& c) const {
    const double stretch = 1 + trace(c) - D;
    return implicitViscosity(dt) * (stretch > 1 ? stretch : 1);
  }

  /// c after dt [s] with the gradient L, L(r, s) = du_r/dx_s [1/s]. It stays positive definite, however long the
  /// step. K is that of the mean of both ends; with it the solution is exact,
  ///   c(dt) = P c P^T + X,   P = exp(A dt),   X = integral of exp(A s) K exp(A^T s) ds,   A = L - K/2,
  /// both by their series over a part of the step, which is doubled.
  template <int D>
  TREACLE_HD SymmetricBlock<D> advanced(const Block<D>& L, double dt, const SymmetricBlock<D>& c) const {
    SymmetricBlock<D> next = c;
    const int passes = mobility > 0 || extensibility > 0 ? 3 : 1;
    for (int k = 0; k < passes; ++k) next = integrated(L, relaxation(0.5 * (c + next)), dt, c);
    return next;
  }

 private:
  /// K [1/s]
  template <int D>
  TREACLE_HD SymmetricBlock<D> relaxation(const SymmetricBlock<D>& c) const {
    constexpr double most = 20;  // of the exponent: the step is divided as the factor asks
    const double x = extensibility * (trace(c) - D);
    const double f = exponential ? std::exp(x < most ? x : most) : 1 + x;
    return (rate * f) * ((1 - mobility) * SymmetricBlock<D>::identity() + mobility * c);
  }

  /// a m + m a^T
  template <int D>
  TREACLE_HD static SymmetricBlock<D> both(const Block<D>& a, const SymmetricBlock<D>& m) {
    const Block<D> am = product<D>(a, m);
    SymmetricBlock<D> sum{};
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s) sum(r, s) = am(r, s) + am(s, r);
    return sum;
  }
  /// p m p^T
  template <int D>
  TREACLE_HD static SymmetricBlock<D> carried(const Block<D>& p, const SymmetricBlock<D>& m) {
    const Block<D> pm = product<D>(p, m);
    SymmetricBlock<D> sum{};
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s)
        for (int k = 0; k < D; ++k) sum(r, s) += pm(r, k) * p(s, k);
    return sum;
  }

  template <int D>
  TREACLE_HD static SymmetricBlock<D> integrated(const Block<D>& L, const SymmetricBlock<D>& K, double dt,
                                                 const SymmetricBlock<D>& c) {
    Block<D> a = L;
    double largest = 0;
    for (int r = 0; r < D; ++r)
      for (int s = 0; s < D; ++s) {
        a(r, s) -= 0.5 * K(r, s);
        largest = std::fmax(largest, std::fabs(a(r, s)));
      }
    constexpr double small = 0.05;  // of A times a part of the step, where terms of fifth order are 1e-9
    constexpr int most = 60;
    int doublings = 0;
    double h = dt;
    for (; D * largest * h > small && doublings < most; ++doublings) h *= 0.5;
    Block<D> p = Block<D>::diagonal(1), power = p;
    SymmetricBlock<D> x{}, term = K;
    double factor = 1;
    for (int k = 1; k <= 4; ++k) {
      factor *= h / k;
      x += factor * term;
      term = both(a, term);
      power = product<D>(power, a);
      for (int n = 0; n < D * D; ++n) p.a[n] += factor * power.a[n];
    }
    for (int k = 0; k < doublings; ++k) {
      x += carried(p, x);
      p = product<D>(p, p);
    }
    return carried(p, c) + x;
  }
};

}  // namespace treacle
