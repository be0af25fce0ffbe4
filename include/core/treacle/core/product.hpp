#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/symmetric_block.hpp"

namespace treacle {

/// a b, where both are matrices of D rows and columns with elements (r, c).
template <int D, class A, class B>
TREACLE_HD Block<D> product(const A& a, const B& b) {
  Block<D> p{};
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c)
      for (int k = 0; k < D; ++k) p(r, c) += a(r, k) * b(k, c);
  return p;
}

}  // namespace treacle
