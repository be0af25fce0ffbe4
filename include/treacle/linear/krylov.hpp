#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/linear/krylov_loop.hpp"
#include "treacle/linear/vector.hpp"

#include <array>
#include <span>

namespace treacle {

template <class Backend = Cpu>
struct KrylovWorkspace {
  std::array<Buffer<double, Backend>, 5> vectors;
  KrylovLoop<Backend> loop;

  void resize(const Context<Backend>& context, std::size_t n) {
    for (auto& v : vectors) v.resize(context, n);
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& v : vectors) sum += v.bytes();
    return sum;
  }
};

/// scalars.setDirection(r.z), then p = z + beta p
template <class Backend>
void plainDirection(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                    std::span<double> p, KrylovScalars* scalars) {
  directionDot(context, r, z, scalars);
  direction(context, z, p, scalars);
}

/// How conjugate gradients choose their directions; see Deflation for another way.
struct PlainDirections {
  template <class Backend, class Operator>
  void prepare(Context<Backend>&, const Operator&, std::span<double>) const {}
  template <class Backend>
  void guess(Context<Backend>&, std::span<double>, std::span<double>, KrylovScalars*) const {}
  template <class Backend>
  void direction(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                 std::span<double> p, KrylovScalars* scalars) const {
    plainDirection(context, r, z, p, scalars);
  }
};

/// Preconditioned conjugate gradients [K23 eqs. (21)-(32), M = A^-1]. `x`: first guess and solution.
/// `a(x, y)` computes y = A x and `m(r, z)` z = K r, both symmetric positive definite.
template <class Backend, class Operator, class Preconditioner, class Directions = PlainDirections>
SolveReport conjugateGradient(Context<Backend>& context, const Operator& a, const Preconditioner& m,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace, Directions&& directions = {}) {
  using Vector = std::span<const double>;
  workspace.resize(context, b.size());
  auto& [r, z, p, q, spare] = workspace.vectors;
  // z = K r is new in every iteration: nothing to refresh.
  KrylovScalars* scalars = workspace.loop.begin(context, {rule.tolerance, rule.maxIterations, 0, rule.history});

  directions.prepare(context, a, spare.span());
  a(Vector(x), r.span());
  residual(context, b, r, scalars);
  directions.guess(context, x, r.span(), scalars);
  const SolveReport atStart = workspace.loop.report(context);
  if (atStart.status != SolveStatus::Running) return atStart;

  workspace.loop.record(context, [&] {
    m(Vector(r), z.span());
    directions.direction(context, r, z, p.span(), scalars);
    a(Vector(p), q.span());
    stepDot(context, p, q, scalars);
    updateCg(context, {p, q, x, r}, scalars);
  });
  return workspace.loop.run(context);
}

/// Preconditioned conjugate residuals [K23 eqs. (21)-(32), M = K]; s = K r is carried along, so that an iteration
/// needs one product with A and one with K.
template <class Backend, class Operator, class Preconditioner>
SolveReport conjugateResidual(Context<Backend>& context, const Operator& a, const Preconditioner& m,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace) {
  using Vector = std::span<const double>;
  workspace.resize(context, b.size());
  // u = K q and y = A s are never alive together: one vector serves both.
  auto& [r, s, p, q, y] = workspace.vectors;
  auto& u = y;
  KrylovScalars* scalars = workspace.loop.begin(context, rule);

  a(Vector(x), r.span());
  residual(context, b, r, scalars);
  SolveReport report = workspace.loop.report(context);
  if (report.status != SolveStatus::Running) return report;

  workspace.loop.record(context, [&] {
    a(Vector(s), y.span());
    directionDot(context, s, y, scalars);
    directionsCr(context, {s, y, p, q}, scalars);
    m(Vector(q), u.span());
    stepDot(context, q, u, scalars);
    updateCr(context, {p, q, u, x, r, s}, scalars);
  });
  do {
    m(Vector(r), s.span());
    report = workspace.loop.run(context);
  } while (report.status == SolveStatus::Refresh);
  return report;
}

}  // namespace treacle
