#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/deflation_scalars.hpp"
#include "treacle/linear/vector.hpp"

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
template <class Backend>
void widen(Context<Backend>&, std::span<const float> from, std::span<double> to);

/// Row j of E: the products of W with column j of A W.
void galerkinRow(Context<Cpu>&, const Deflated& d, int j);
void galerkinRow(Context<Cuda>&, const Deflated& d, int j);

template <class Backend>
void setInverse(Context<Backend>&, const ModeMatrix& inverse, DeflationScalars* to);

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
template <class Backend>
void recordedDirection(Context<Backend>&, std::span<const double> r, std::span<const double> z,
                       std::span<double> p, KrylovScalars* krylov, DeflationScalars* scalars,
                       std::span<float> basis);

/// W = basis times the coefficients
void combine(Context<Cpu>&, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w);
void combine(Context<Cuda>&, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w);

/// scalars.setDirection(r.z), then p = z + beta p, rounded to numbers in single precision where `single`.
template <class Backend>
void plainDirection(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                    std::span<double> p, KrylovScalars* scalars, bool single = false) {
  directionDot(context, r, z, scalars);
  direction(context, z, p, scalars, single);
}

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
  void deflateBy(std::span<const float> modes, std::size_t n);
  void recordNumbers(Context<Backend>& context);
  /// Errors: std::bad_alloc.
  void record(Context<Backend>& context, std::size_t n);

  /// What conjugateGradient calls: before the solve (`spare`: a vector to use), for its first guess with the
  /// residual r, and for each direction.
  void prepare(Context<Backend>& context, const Product& a, std::span<double> spare);
  void guess(Context<Backend>& context, std::span<double> x, std::span<double> r, KrylovScalars* krylov);
  void direction(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                 std::span<double> p, KrylovScalars* krylov);

  /// Modes of the solve that was recorded, which took so many iterations.
  RitzVectors ritzVectors(Context<Backend>& context, int iterations, int most) const;
  void takeModes(Context<Backend>& context, const RitzVectors& ritz, std::span<float> to);
  /// Gives up the memory that only solves with modes, or such that are recorded, need.
  void release() { work_ = {}, recorded_ = {}; }

  std::size_t bytes() const { return work_.bytes() + scalars_.bytes(); }

 private:
  enum class Use { Nothing, Modes, Record };

  DeflationScalars onHost(const Context<Backend>& context) const;
  int modeCount() const { return static_cast<int>(modes_.size() / n_); }
  Deflated view();
  std::span<double> product(int j) { return {reinterpret_cast<double*>(work_.data()) + j * n_, n_}; }

  Use use_ = Use::Nothing;
  std::size_t n_ = 0;
  std::span<const float> modes_;
  std::span<float> recorded_;        // in `work_`
  Buffer<std::byte, Backend> work_;  // A W, or the recorded vectors: no solve has both
  Buffer<DeflationScalars, Backend> scalars_;
};

}  // namespace treacle
