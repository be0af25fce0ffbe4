#include "treacle/linear/krylov.hpp"

namespace treacle {

template <class Backend>
SolveReport conjugateGradient(Context<Backend>& context, const LinearSystem& system, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace, Deflation<Backend>* deflation) {
  const auto& [a, k, b, x, single] = system;
  workspace.resize(context, b.size(), 4);
  auto& [r, z, p, q, none] = workspace.vectors;
  // z = K r is new in every iteration: nothing to refresh.
  KrylovScalars* scalars = workspace.loop.begin(context, {rule.tolerance, rule.maxIterations, 0, rule.history});

  if (deflation) deflation->prepare(context, a, z.span());
  a(x, r.span());
  residual(context, b, r, scalars);
  if (deflation) deflation->guess(context, x, r.span(), scalars);
  // Before the host waits: a device works while its graph is made.
  workspace.loop.record(context, [&] {
    k(r.span(), z.span());
    if (deflation)
      deflation->direction(context, r, z, p.span(), scalars);
    else
      plainDirection(context, r, z, p.span(), scalars, single != nullptr);
    (single ? *single : a)(p.span(), q.span());
    stepDot(context, p, q, scalars);
    updateSolution(context, {p, q, x, r}, scalars);
  });
  SolveReport report = workspace.loop.report(context);
  if (report.status == SolveStatus::Running) report = workspace.loop.run(context);
  workspace.giveUp();
  return report;
}

template <class Backend>
SolveReport conjugateResidual(Context<Backend>& context, const LinearSystem& system, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace) {
  const auto& [a, k, b, x, single] = system;
  workspace.resize(context, b.size(), 5);
  // u = K q and y = A s are never alive together: one vector serves both.
  auto& [r, s, p, q, y] = workspace.vectors;
  auto& u = y;
  KrylovScalars* scalars = workspace.loop.begin(context, rule);

  a(x, r.span());
  residual(context, b, r, scalars);
  SolveReport report = workspace.loop.report(context);
  if (report.status != SolveStatus::Running) return report;

  workspace.loop.record(context, [&] {
    a(s.span(), y.span());
    directionDot(context, s, y, scalars);
    directionsCr(context, {s, y, p, q}, scalars);
    k(q.span(), u.span());
    stepDot(context, q, u, scalars);
    updateSolution(context, {p, q, x, r, u, s}, scalars);
  });
  do {
    k(r.span(), s.span());
    report = workspace.loop.run(context);
  } while (report.status == SolveStatus::Refresh);
  workspace.giveUp();
  return report;
}

#define TREACLE_INSTANTIATE(Backend)                                                                  \
  template SolveReport conjugateGradient(Context<Backend>&, const LinearSystem&, const StoppingRule&, \
                                         KrylovWorkspace<Backend>&, Deflation<Backend>*);             \
  template SolveReport conjugateResidual(Context<Backend>&, const LinearSystem&, const StoppingRule&, \
                                         KrylovWorkspace<Backend>&);
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
