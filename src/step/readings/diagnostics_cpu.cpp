#include "treacle/step/readings/diagnostics.hpp"

#include "treacle/core/processes.hpp"

#include <functional>

namespace treacle {

template <int D, class Backend>
Diagnostics computeDiagnostics(Context<Backend>& context, const DiagnosticsInput<D>& in) {
  const auto term = DiagnosticsTerm<D>::make(in);
  Diagnostics d = noDiagnostics();
  for (std::size_t i = 0; i < in.position.size(); ++i) d = joined(d, term(in, i));
  d = joinedOverProcesses(context, d, [](const Diagnostics& a, const Diagnostics& b) { return joined(a, b); });
  return averaged(d, joinedOverProcesses(context, in.position.size(), std::plus<>()), in.ownShare());
}

template Diagnostics computeDiagnostics(Context<Cpu>&, const DiagnosticsInput<2>&);
template Diagnostics computeDiagnostics(Context<Cpu>&, const DiagnosticsInput<3>&);

}  // namespace treacle
