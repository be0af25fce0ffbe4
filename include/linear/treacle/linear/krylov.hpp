#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/linear/deflation.hpp"
#include "treacle/linear/krylov_loop.hpp"
#include "treacle/linear/vector.hpp"

#include <array>
#include <span>

namespace treacle {

template <class Backend = Cpu>
struct KrylovWorkspace {
  std::array<Buffer<double, Backend>, 5> vectors;
  KrylovLoop<Backend> loop;

  /// The first `count` vectors, of n numbers.
  void resize(const Context<Backend>& context, std::size_t n, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) vectors[k].resize(context, n);
  }
  void giveUp() {
    for (auto& v : vectors) treacle::giveUp(v);
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& v : vectors) sum += v.bytes();
    return sum;
  }
};

/// A x = b with a preconditioner K, both symmetric positive definite.
struct LinearSystem {
  const Product& a;  // y = A x
  const Product& k;  // z = K r
  std::span<const double> b;
  std::span<double> x;              // first guess and solution
  const Product* single = nullptr;  // y = A p of directions p whose numbers are single precision
};

/// Preconditioned conjugate gradients [K23 eqs. (21)-(32), M = A^-1]. `deflation`: how directions are chosen;
/// null: as usual. Where the system has `single`, directions are rounded to single precision; x and r follow the
/// rounded directions, so that the solution is no less accurate.
template <class Backend>
SolveReport conjugateGradient(Context<Backend>& context, const LinearSystem& system, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace, Deflation<Backend>* deflation = nullptr);

/// Preconditioned conjugate residuals [K23 eqs. (21)-(32), M = K]; s = K r is carried along, so that an iteration
/// needs one product with A and one with K.
template <class Backend>
SolveReport conjugateResidual(Context<Backend>& context, const LinearSystem& system, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace);

}  // namespace treacle
