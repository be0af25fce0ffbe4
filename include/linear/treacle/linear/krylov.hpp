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

/// Preconditioned conjugate gradients [K23 eqs. (21)-(32), M = A^-1]. `x`: first guess and solution; `a`: y = A x,
/// `k`: z = K r, both symmetric positive definite. `deflation`: how directions are chosen; null: as usual.
/// `single`: y = A p of directions p whose numbers are single precision; where it is given directions are rounded
/// to such ones. x and r follow the rounded directions, so that the solution is no less accurate.
template <class Backend>
SolveReport conjugateGradient(Context<Backend>& context, const Product& a, const Product& k,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace, Deflation<Backend>* deflation = nullptr,
                              const Product* single = nullptr);

/// Preconditioned conjugate residuals [K23 eqs. (21)-(32), M = K]; s = K r is carried along, so that an iteration
/// needs one product with A and one with K.
template <class Backend>
SolveReport conjugateResidual(Context<Backend>& context, const Product& a, const Product& k,
                              std::span<const double> b, std::span<double> x, const StoppingRule& rule,
                              KrylovWorkspace<Backend>& workspace);

}  // namespace treacle
