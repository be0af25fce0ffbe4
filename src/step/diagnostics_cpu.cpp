#include "treacle/step/diagnostics.hpp"

namespace treacle {

template <int D>
Diagnostics computeDiagnostics(Context<Cpu>&, const DiagnosticsInput<D>& in) {
  const auto term = DiagnosticsTerm<D>::make(in);
  Diagnostics d = noDiagnostics();
  for (std::size_t i = 0; i < in.position.size(); ++i) d = joined(d, term(in, i));
  return averaged(d, in.position.size());
}

template Diagnostics computeDiagnostics<2>(Context<Cpu>&, const DiagnosticsInput<2>&);
template Diagnostics computeDiagnostics<3>(Context<Cpu>&, const DiagnosticsInput<3>&);

}  // namespace treacle
