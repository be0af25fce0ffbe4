#pragma once

#include "treacle/core/symmetric_block.hpp"

#include <algorithm>

namespace treacle {

/// For comparisons of whole fields.
template <int D>
bool operator==(const SymmetricBlock<D>& a, const SymmetricBlock<D>& b) {
  return std::equal(a.a, a.a + a.size, b.a);
}

}  // namespace treacle
