#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/linear/vector.hpp"

#include <array>
#include <cmath>
#include <span>

namespace treacle {

struct StoppingRule {
  double tolerance = 1e-12;  // bound on |r|^2 / |b|^2
  int maxIterations = 5000;
  /// CR: s = K r is computed anew when |r|^2 has fallen by this factor since the last time; 0: never. The
  /// recursion for s keeps the rounding errors of K, and in single precision those outgrow s before the tolerance
  /// is reached.
  double refresh = 0;
};

enum class SolveStatus { Converged, IterationLimit, Breakdown, NotFinite };

struct SolveReport {
  SolveStatus status = SolveStatus::Converged;
  int iterations = 0;
  double residual = 0;  // |r|^2 / |b|^2 of the recursion
};

template <class Backend = Cpu>
struct KrylovWorkspace {
  std::array<Buffer<double, Backend>, 5> vectors;

  void resize(std::size_t n) {
    for (auto& v : vectors) v.resize(n);
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& v : vectors) sum += v.bytes();
    return sum;
  }
};

/// The stopping test of both methods. A zero right-hand side asks for a zero residual.
struct StoppingTest {
  StoppingRule rule;
  double bb;  // |b|^2

  /// True when the loop ends; fills the report.
  bool operator()(double rr, int iteration, SolveReport& report) const {
    report.iterations = iteration;
    report.residual = bb > 0 ? rr / bb : rr;
    if (!std::isfinite(rr))
      report.status = SolveStatus::NotFinite;
    else if (rr <= rule.tolerance * bb)
      report.status = SolveStatus::Converged;
    else if (iteration >= rule.maxIterations)
      report.status = SolveStatus::IterationLimit;
    else
      return false;
    return true;
  }
};

/// Preconditioned conjugate gradients [K23 eqs. (21)-(32), M = A^-1]. `x`: first guess and solution.
/// `a(x, y)` computes y = A x and `m(r, z)` z = K r, both symmetric positive definite.
template <class Backend, class Operator, class Preconditioner>
SolveReport conjugateGradient(Context<Backend>& context, const Operator& a, const Preconditioner& m,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace) {
  workspace.resize(b.size());
  auto& [r, z, p, q, unused] = workspace.vectors;
  const StoppingTest done{rule, dot(context, b, b)};
  SolveReport report;

  a(std::span<const double>(x), r.span());
  double rr = residual(context, b, r), rzOld = 1;
  for (int k = 0; !done(rr, k, report); ++k) {
    m(std::span<const double>(r), z.span());
    const double rz = dot(context, r, z);
    if (k == 0)
      copy(context, z, p);
    else
      direction(context, z, rz / rzOld, p);
    a(std::span<const double>(p), q.span());
    const double pq = dot(context, p, q);
    if (!(rz > 0 && pq > 0)) {
      report.status = std::isfinite(rz) && std::isfinite(pq) ? SolveStatus::Breakdown : SolveStatus::NotFinite;
      return report;
    }
    rr = updateCg(context, rz / pq, {p, q, x, r});
    rzOld = rz;
  }
  return report;
}

/// Preconditioned conjugate residuals [K23 eqs. (21)-(32), M = K]; s = K r is carried along, so that an iteration
/// needs one product with A and one with K.
template <class Backend, class Operator, class Preconditioner>
SolveReport conjugateResidual(Context<Backend>& context, const Operator& a, const Preconditioner& m,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace) {
  workspace.resize(b.size());
  // u = K q and y = A s are never alive together: one vector serves both.
  auto& [r, s, p, q, y] = workspace.vectors;
  auto& u = y;
  const StoppingTest done{rule, dot(context, b, b)};
  SolveReport report;

  a(std::span<const double>(x), r.span());
  double rr = residual(context, b, r), rhoOld = 1;
  if (done(rr, 0, report)) return report;
  m(std::span<const double>(r), s.span());
  double rrOfS = rr;
  for (int k = 0; !done(rr, k, report); ++k) {
    if (rr < rule.refresh * rrOfS) {
      m(std::span<const double>(r), s.span());
      rrOfS = rr;
    }
    a(std::span<const double>(s), y.span());
    const double rho = dot(context, s, y);
    if (k == 0) {
      copy(context, s, p);
      copy(context, y, q);
    } else {
      directionsCr(context, rho / rhoOld, {s, y, p, q});
    }
    m(std::span<const double>(q), u.span());
    const double qu = dot(context, q, u);
    if (!(rho > 0 && qu > 0)) {
      report.status = std::isfinite(rho) && std::isfinite(qu) ? SolveStatus::Breakdown : SolveStatus::NotFinite;
      return report;
    }
    rr = updateCr(context, rho / qu, {p, q, u, x, r, s});
    rhoOld = rho;
  }
  return report;
}

}  // namespace treacle
