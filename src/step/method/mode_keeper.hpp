#pragma once

#include "treacle/linear/deflation.hpp"
#include "treacle/model/state/solver_modes.hpp"

namespace treacle {

/// Deflates solves by the modes that the particles carry along, and takes them anew when they are due.
template <int D, class Backend = Cpu>
class ModeKeeper {
 public:
  /// Makes ready for a solve, which conjugateGradient is to be given the result for. `most`: number of modes.
  Deflation<Backend>& prepare(Context<Backend>&, SolverModes<D, Backend>&, std::size_t particles, int most);
  /// After it. A failure drops the modes.
  void finish(Context<Backend>&, SolverModes<D, Backend>&, const SolveReport&, int most);

  std::size_t bytes() const { return deflation_.bytes(); }

 private:
  enum class Kind { Deflated, Looked, Recorded };

  Kind solve_ = Kind::Deflated;  // the solve at hand
  std::size_t particles_ = 0;
  Deflation<Backend> deflation_;
};

}  // namespace treacle
