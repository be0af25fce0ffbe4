#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/deflation_scalars.hpp"
#include "treacle/linear/krylov.hpp"

#include <cstddef>
#include <span>

namespace treacle {

/// The vector operations of Deflation. W and the recorded vectors are columns of the length n, one after the
/// other; everything is in the backend's memory. Sums have a fixed order.
struct Deflated {
  std::span<const float> w;    // W
  std::span<const double> aw;  // A W
  int modes = 0;
  DeflationScalars* scalars = nullptr;
};

/// to = from
void widen(Context<Cpu>&, std::span<const float> from, std::span<double> to);
void widen(Context<Cuda>&, std::span<const float> from, std::span<double> to);

/// Row j of E: the products of W with column j of A W.
void galerkinRow(Context<Cpu>&, const Deflated& d, int j);
void galerkinRow(Context<Cuda>&, const Deflated& d, int j);

void setInverse(Context<Cpu>&, const ModeMatrix& inverse, DeflationScalars* to);
void setInverse(Context<Cuda>&, const ModeMatrix& inverse, DeflationScalars* to);

/// c = E^-1 W^T r, x += W c, r -= A W c, and krylov.start(b.b, r.r) with the b.b that is known
void deflateGuess(Context<Cpu>&, const Deflated& d, std::span<double> x, std::span<double> r,
                  KrylovScalars* krylov);
void deflateGuess(Context<Cuda>&, const Deflated& d, std::span<double> x, std::span<double> r,
                  KrylovScalars* krylov);

/// krylov.setDirection(r.z), c = E^-1 (A W)^T z, then p = z + beta p - W c. Two passes, of 1 + 2 k and 3 + k / 2
/// vectors of traffic.
void deflatedDirection(Context<Cpu>&, const Deflated& d, std::span<const double> r, std::span<const double> z,
                       std::span<double> p, KrylovScalars* krylov);
void deflatedDirection(Context<Cuda>&, const Deflated& d, std::span<const double> r, std::span<const double> z,
                       std::span<double> p, KrylovScalars* krylov);

/// krylov.setDirection(r.z), then p = z + beta p; the first iterations leave their scalars, and as column i of
/// `basis`, unless it is empty, the vector (-1)^i z / sqrt(rho) of Lanczos' method.
void recordedDirection(Context<Cpu>&, std::span<const double> r, std::span<const double> z, std::span<double> p,
                       KrylovScalars* krylov, DeflationScalars* scalars, std::span<float> basis);
void recordedDirection(Context<Cuda>&, std::span<const double> r, std::span<const double> z, std::span<double> p,
                       KrylovScalars* krylov, DeflationScalars* scalars, std::span<float> basis);

/// W = basis times the coefficients
void combine(Context<Cpu>&, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w);
void combine(Context<Cuda>&, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w);

/// Conjugate gradients whose directions are A-orthogonal to a few given vectors W, the modes: the eigenvalues of
/// M A that belong to them no longer slow the others down (docs/solver.md). The modes are Ritz vectors of an
/// earlier solve that was recorded. A new A needs nothing but A W. W is kept in single precision; A W and E = W^T
/// A W are formed from those very numbers in double, so that directions are A-orthogonal to W in double.
template <class Backend = Cpu>
class Deflation {
 public:
  /// Ritz values worth a mode. In three dimensions none is, most of the time.
  static constexpr double leastValue = 3;

  /// The next solve, of n unknowns, is deflated by modes of that length; or recorded; or only its numbers are,
  /// which needs no memory and shows whether there are modes worth taking.
  void deflateBy(std::span<const float> modes, std::size_t n) {
    use_ = modes.empty() ? Use::Nothing : Use::Modes;
    n_ = n;
    modes_ = modes;
  }
  void recordNumbers(Context<Backend>& context) {
    use_ = Use::Record;
    recorded_ = {};
    scalars_.resize(context, 1);
  }
  /// Errors: std::bad_alloc.
  void record(Context<Backend>& context, std::size_t n) {
    recordNumbers(context);
    work_.resize(context, n * DeflationScalars::maxBasis * sizeof(float));
    recorded_ = {reinterpret_cast<float*>(work_.data()), n * DeflationScalars::maxBasis};
  }

  /// What conjugateGradient calls: before the solve (`spare`: a vector to use), for its first guess with the
  /// residual r, and for each direction.
  template <class Operator>
  void prepare(Context<Backend>&, const Operator& a, std::span<double> spare);
  void guess(Context<Backend>& context, std::span<double> x, std::span<double> r, KrylovScalars* krylov) {
    if (use_ == Use::Modes) deflateGuess(context, view(), x, r, krylov);
  }
  void direction(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                 std::span<double> p, KrylovScalars* krylov) {
    switch (use_) {
      case Use::Nothing:
        return plainDirection(context, r, z, p, krylov);
      case Use::Modes:
        return deflatedDirection(context, view(), r, z, p, krylov);
      case Use::Record:
        return recordedDirection(context, r, z, p, krylov, scalars_.data(), recorded_);
    }
  }

  /// Modes of the solve that was recorded, which took so many iterations.
  RitzVectors ritzVectors(Context<Backend>& context, int iterations, int most) const {
    return largestRitzVectors(onHost(context), iterations, most, leastValue);
  }
  void takeModes(Context<Backend>& context, const RitzVectors& ritz, std::span<float> to) {
    combine(context, recorded_, ritz, to);
  }
  /// Gives up the memory that only solves with modes, or such that are recorded, need.
  void release() { work_ = {}, recorded_ = {}; }

  std::size_t bytes() const { return work_.bytes() + scalars_.bytes(); }

 private:
  enum class Use { Nothing, Modes, Record };

  DeflationScalars onHost(const Context<Backend>& context) const {
    if constexpr (std::is_same_v<Backend, Cuda>)
      return valueOnHost(context, scalars_.data());
    else
      return scalars_[0];
  }
  int modeCount() const { return static_cast<int>(modes_.size() / n_); }
  Deflated view() {
    const std::size_t size = modes_.size();
    return {modes_, {reinterpret_cast<const double*>(work_.data()), size}, modeCount(), scalars_.data()};
  }
  std::span<double> product(int j) { return {reinterpret_cast<double*>(work_.data()) + j * n_, n_}; }

  Use use_ = Use::Nothing;
  std::size_t n_ = 0;
  std::span<const float> modes_;
  std::span<float> recorded_;        // in `work_`
  Buffer<std::byte, Backend> work_;  // A W, or the recorded vectors: no solve has both
  Buffer<DeflationScalars, Backend> scalars_;
};

template <class Backend>
template <class Operator>
void Deflation<Backend>::prepare(Context<Backend>& context, const Operator& a, std::span<double> spare) {
  if (use_ != Use::Modes) return;
  scalars_.resize(context, 1);
  work_.resize(context, modes_.size() * sizeof(double));
  for (int j = 0; j < modeCount(); ++j) {
    widen(context, modes_.subspan(j * n_, n_), spare);
    a(std::span<const double>(spare), product(j));
    galerkinRow(context, view(), j);
  }
  ModeMatrix inverse;
  if (invert(onHost(context).galerkin, modeCount(), inverse) > 0)
    setInverse(context, inverse, scalars_.data());
  else
    use_ = Use::Nothing;
}

}  // namespace treacle
