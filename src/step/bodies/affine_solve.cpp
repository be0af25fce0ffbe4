#include "affine_solve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace treacle {
namespace {

constexpr int patience = 8;      // steps by which the derivative is made better before it is found anew
constexpr double nearby = 1e-3;  // from values that much of the scale aside
constexpr double known = 100;    // tolerances that are enough once a derivative that was found anew did not do

using Vector = std::vector<double>;

/// a^-1 b of n x n and n x m numbers, row by row: Gauss with pivots, once for all columns of b. A column of a
/// without a pivot gives zero.
Vector solved(Vector a, Vector b, std::size_t n) {
  const std::size_t m = b.size() / n;
  const auto subtract = [&](std::size_t from, double factor, std::size_t row) {
    for (std::size_t c = 0; c < m; ++c) b[row * m + c] -= factor * b[from * m + c];
  };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (a[pivot * n + k] == 0) continue;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
    for (std::size_t c = 0; c < m; ++c) std::swap(b[k * m + c], b[pivot * m + c]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      subtract(k, factor, i);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) subtract(j, a[k * n + j], k);
    const double pivot = a[k * n + k];
    for (std::size_t c = 0; c < m; ++c) b[k * m + c] = pivot == 0 ? 0 : b[k * m + c] / pivot;
  }
  return b;
}

/// Of the values over their scales.
double largest(const Vector& v, const Vector& scale) {
  double most = 0;
  for (std::size_t k = 0; k < v.size(); ++k) most = std::max(most, std::abs(v[k]) / scale[k]);
  return most;
}

/// Whether some unknown changes nothing.
bool hasIdle(const Vector& derivative, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    bool acts = false;
    for (std::size_t i = 0; i < n; ++i) acts = acts || derivative[i * n + j] != 0;
    if (!acts) return true;
  }
  return false;
}

double product(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// What moves the zero along one row.
struct Mover {
  const Vector* row;
  Vector way;         // by which a push of 1 moves the zero
  double length = 0;  // of that, over the scales of the unknowns
  double rate = 0;    // of row . x along it
  double push = 0;

  /// What row . x lacks of `aim`.
  double missing(double aim, const Vector& x) const { return aim - product(*row, x); }
  /// Returns how far x has gone, over the scales.
  double change(double by, Vector& x) {
    if (by == 0) return 0;
    push += by;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += by * way[k];
    return std::abs(by) * length;
  }
};

struct HeldRestraint {
  const Restraint* restraint;
  Mover normal;
  std::vector<Mover> slides{};  // as those of the restraint
  double rate = 0;              // of all slides together, along whatever direction, at most

  double hold(Vector& x) {
    const double missing = normal.missing(restraint->least, x) / normal.rate;
    return normal.change(std::max(missing, -normal.push), x);
  }

  /// A step of the same length along all slides, so that what is cut off leaves the direction of what is missing.
  double slide(Vector& x) {
    double length2 = 0;
    Vector wanted;
    for (std::size_t s = 0; s < slides.size(); ++s) {
      wanted.push_back(slides[s].push + slides[s].missing(restraint->slides[s].rest, x) / rate);
      length2 += wanted.back() * wanted.back();
    }
    const double most = restraint->grip * normal.push, length = std::sqrt(length2);
    const double part = length > most ? most / length : 1;
    double moved = 0;
    for (std::size_t s = 0; s < slides.size(); ++s)
      moved = std::max(moved, slides[s].change(part * wanted[s] - slides[s].push, x));
    return moved;
  }
};

/// Moves what the derivative would take for the zero to where all restraints hold, by their pushes: one after the
/// other until none moves it by more than `least` of the scales (projected Gauss-Seidel). What they cannot do
/// together stays.
void restrain(const Vector& derivative, const std::vector<Restraint>& restraints, const Vector& scale,
              double least, Vector& x) {
  constexpr int mostRounds = 2000;
  if (restraints.empty()) return;
  const std::size_t n = x.size();
  Vector unit(n * n);
  for (std::size_t k = 0; k < n; ++k) unit[k * n + k] = 1;
  const Vector ways = solved(derivative, unit, n);  // column j: by which a residual of 1 in place j moves the zero
  const auto mover = [&](const Vector& row, const Vector& push) {
    Mover m{&row, Vector(n)};
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n && push[j] != 0; ++k) m.way[k] += push[j] * ways[k * n + j];
    m.length = largest(m.way, scale);
    m.rate = product(row, m.way);
    return m;
  };
  std::vector<HeldRestraint> held;
  for (const Restraint& r : restraints) {
    HeldRestraint h{&r, mover(r.row, r.push)};
    if (!(h.normal.rate > 0)) continue;
    double rate2 = 0;
    for (const Restraint::Slide& s : r.slides) h.slides.push_back(mover(s.row, s.push));
    for (const Mover& a : h.slides)
      for (const Mover& b : h.slides) rate2 += product(*a.row, b.way) * product(*a.row, b.way);
    h.rate = std::sqrt(rate2);
    // The body is locked, or the derivative is not any good yet.
    if (h.rate == 0 || std::ranges::any_of(h.slides, [](const Mover& m) { return m.rate < 0; })) h.slides.clear();
    held.push_back(std::move(h));
  }
  for (int round = 0; round < mostRounds; ++round) {
    double moved = 0;
    for (HeldRestraint& h : held) {
      moved = std::max(moved, h.hold(x));
      moved = std::max(moved, h.slide(x));
    }
    if (moved <= least) return;
  }
}

}  // namespace

AffineSolve::Result AffineSolve::run(const Function& f, Vector& x, Vector& derivative, const Vector& scale,
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
      aside[j] += by * scale[j];
      const Vector there = value(aside);
      for (std::size_t i = 0; i < n; ++i) derivative[i * n + j] = (there[i] - y[i]) / (by * scale[j]);
    }
    isLast = false;
  };
  if (derivative.size() != n * n) differentiate(1);
  for (int k = 0;; ++k) {
    Vector step = solved(derivative, y, n);
    for (std::size_t i = 0; i < n; ++i) step[i] = x[i] - step[i];
    restrain(derivative, restraints, scale, 0.1 * tolerance, step);
    for (std::size_t i = 0; i < n; ++i) step[i] -= x[i];
    result.converged = largest(step, scale) <= (k <= 2 * patience ? 1 : known) * tolerance;
    // What was computed last must be what the unknowns are.
    if ((result.converged && isLast) || k == most) {
      if (hasIdle(derivative, n)) derivative.clear();
      return result;
    }
    if (k > 0 && k % patience == 0) {
      differentiate(nearby);
      continue;
    }
    double length2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step[i];
      length2 += (step[i] / scale[i]) * (step[i] / scale[i]);
    }
    const Vector before = std::exchange(y, value(x));
    isLast = true;
    // What a short step changes may be less than what values are known to.
    if (largest(step, scale) <= 10 * tolerance) continue;
    for (std::size_t i = 0; i < n; ++i) {
      double error = y[i] - before[i];
      for (std::size_t j = 0; j < n; ++j) error -= derivative[i * n + j] * step[j];
      for (std::size_t j = 0; j < n; ++j)
        derivative[i * n + j] += error * step[j] / (scale[j] * scale[j] * length2);
    }
  }
}

}  // namespace treacle
