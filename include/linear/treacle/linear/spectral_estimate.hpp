#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/linear/lanczos_scalars.hpp"

#include <algorithm>
#include <span>

namespace treacle {

/// What Lanczos' method, written as conjugate gradients with the preconditioner D^-1, works on. All in the
/// backend's memory; spans of the same length.
template <class T>
struct LanczosVectors {
  std::span<const T> inverseDiagonal;
  std::span<T> r, p, q;  // residual, direction, and A p
  LanczosScalars* scalars;
};

/// r = D^1/2 u with pseudo-random u that depends on the index alone, p = D^-1 r; scalars.start(r.p)
template <class T, class Backend>
void lanczosStart(Context<Backend>&, const LanczosVectors<T>& v);

/// scalars.setStep(p.q)
template <class T, class Backend>
void lanczosStep(Context<Backend>&, const LanczosVectors<T>& v);

/// r -= alpha q; scalars.setDirection(r.D^-1 r); then p = D^-1 r + beta p
template <class T, class Backend>
void lanczosDirection(Context<Backend>&, const LanczosVectors<T>& v);

/// The largest eigenvalue of the tridiagonal matrix times a margin, or 1 where it is empty.
template <class T, class Backend>
void lanczosFinish(Context<Backend>&, const LanczosScalars* scalars, double margin, T* largest);

/// *to = value
template <class T, class Backend>
void setNumber(Context<Backend>&, T value, T* to);

/// Largest eigenvalue of D^-1 A for symmetric positive (semi-)definite A and diagonal D, a little above rather
/// than below: what a Chebyshev smoother divides by. The host never waits.
template <class T, class Backend = Cpu>
class SpectralEstimate {
 public:
  static constexpr double margin = 1.1;  // Lanczos' values approach the eigenvalue from below

  /// `a(x, y)`: y = A x for spans in the backend's memory. Unknowns where `inverseDiagonal` is zero are left out.
  /// At most LanczosScalars::maxSteps steps.
  template <class Operator>
  void run(Context<Backend>& context, const Operator& a, std::span<const T> inverseDiagonal, int steps = 10) {
    const std::size_t n = inverseDiagonal.size();
    for (Buffer<T, Backend>* v : {&r_, &p_, &q_}) v->resize(context, n);
    known_ = 0;
    scalars_.resize(context, 1);
    largest_.resize(context, 1);
    const LanczosVectors<T> v{inverseDiagonal, r_, p_, q_, scalars_.data()};
    lanczosStart<T>(context, v);
    steps = std::min(steps, LanczosScalars::maxSteps);
    const bool any = n > 0 || context.communicator;  // of several processes all go on
    for (int j = 0; any && j < steps; ++j) {
      if (j > 0) lanczosDirection<T>(context, v);
      a(std::span<const T>(p_.span()), q_.span());
      lanczosStep<T>(context, v);
    }
    lanczosFinish<T>(context, scalars_.data(), margin, largest_.data());
    giveUp(r_, p_, q_);
  }

  /// A bound that is known.
  void assume(Context<Backend>& context, T bound) {
    if (known_ == bound) return;
    largest_.resize(context, 1);
    setNumber(context, bound, largest_.data());
    known_ = bound;
  }

  /// The estimate, margin included; 1 where no unknown takes part. In the backend's memory.
  const T* largest() const { return largest_.data(); }

  /// The same, waited for.
  T onHost(Context<Backend>& context) const { return valueOnHost(context, largest()); }

  std::size_t bytes() const { return r_.bytes() + p_.bytes() + q_.bytes() + scalars_.bytes() + largest_.bytes(); }

 private:
  Buffer<T, Backend> r_, p_, q_;
  Buffer<LanczosScalars, Backend> scalars_;
  Buffer<T, Backend> largest_;
  T known_ = 0;  // what was assumed last; 0: nothing
};

}  // namespace treacle
