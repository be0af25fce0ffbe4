#include "treacle/linear/affine_solve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace treacle {
namespace {

constexpr int patience = 8;      // steps by which the derivative is made better before it is found anew
constexpr double nearby = 1e-3;  // from values that much of the scale aside

using Vector = std::vector<double>;

/// Gauss with pivots; a column without one gives zero.
Vector solved(Vector a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (a[pivot * n + k] == 0) continue;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  Vector x(n);
  for (std::size_t k = n; k-- > 0;) {
    double sum = b[k];
    for (std::size_t j = k + 1; j < n; ++j) sum -= a[k * n + j] * x[j];
    x[k] = a[k * n + k] == 0 ? 0 : sum / a[k * n + k];
  }
  return x;
}

double largest(const Vector& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

double product(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// Moves what the derivative would take for the zero to where all restraints hold, by their pushes: one after the
/// other until none moves it by more than `least` (projected Gauss-Seidel). What they cannot do together stays.
void restrain(const Vector& derivative, const std::vector<Restraint>& restraints, double least, Vector& x) {
  constexpr int mostRounds = 2000;
  if (restraints.empty()) return;
  const std::size_t n = x.size();
  std::vector<Vector> ways;  // by which a residual of 1 in one place moves the zero
  for (std::size_t j = 0; j < n; ++j) {
    Vector unit(n);
    unit[j] = 1;
    ways.push_back(solved(derivative, unit));
  }
  struct Held {
    const Restraint* restraint;
    Vector way;       // by which a push of 1 moves the zero
    double rate = 0;  // of row . x along it
    double push = 0;
  };
  std::vector<Held> held;
  for (const Restraint& r : restraints) {
    Vector way(n);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n && r.push[j] != 0; ++k) way[k] += r.push[j] * ways[j][k];
    if (const double rate = product(r.row, way); rate > 0) held.push_back({&r, std::move(way), rate});
  }
  for (int round = 0; round < mostRounds; ++round) {
    double moved = 0;
    for (Held& h : held) {
      const double missing = (h.restraint->least - product(h.restraint->row, x)) / h.rate;
      const double change = std::max(missing, -h.push);
      if (change == 0) continue;
      h.push += change;
      for (std::size_t k = 0; k < n; ++k) x[k] += change * h.way[k];
      moved = std::max(moved, std::abs(change) * largest(h.way));
    }
    if (moved <= least) return;
  }
}

}  // namespace

AffineSolve::Result AffineSolve::run(const Function& f, Vector& x, Vector& derivative, double scale,
                                     double tolerance, int most, const std::vector<Restraint>& restraints) {
  const std::size_t n = x.size();
  Result result;
  const auto value = [&](const Vector& at) {
    ++result.values;
    return f(at);
  };
  Vector y = value(x);
  bool isLast = true;  // the value at x is what was computed last
  const auto differentiate = [&](double by) {
    derivative.assign(n * n, 0);
    for (std::size_t j = 0; j < n; ++j) {
      Vector aside = x;
      aside[j] += by;
      const Vector there = value(aside);
      for (std::size_t i = 0; i < n; ++i) derivative[i * n + j] = (there[i] - y[i]) / by;
    }
    isLast = false;
  };
  if (derivative.size() != n * n) differentiate(scale);
  for (int k = 0;; ++k) {
    Vector step = solved(derivative, y);
    for (std::size_t i = 0; i < n; ++i) step[i] = x[i] - step[i];
    restrain(derivative, restraints, 0.1 * tolerance * scale, step);
    for (std::size_t i = 0; i < n; ++i) step[i] -= x[i];
    result.converged = largest(step) <= tolerance * scale;
    // What was computed last must be what the unknowns are.
    if ((result.converged && isLast) || k == most) return result;
    if (k > 0 && k % patience == 0) {
      differentiate(nearby * scale);
      continue;
    }
    double length2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step[i];
      length2 += step[i] * step[i];
    }
    const Vector before = std::exchange(y, value(x));
    isLast = true;
    if (length2 == 0) continue;
    for (std::size_t i = 0; i < n; ++i) {
      double error = y[i] - before[i];
      for (std::size_t j = 0; j < n; ++j) error -= derivative[i * n + j] * step[j];
      for (std::size_t j = 0; j < n; ++j) derivative[i * n + j] += error * step[j] / length2;
    }
  }
}

}  // namespace treacle
