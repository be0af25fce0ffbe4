#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>

namespace treacle {

/// Interpolation P from coarse to fine rows: one row of weights per fine row, no column twice. Where rows have
/// several unknowns, they share the weights.
template <class Backend = Cpu>
struct Prolongation : BlockCsr<1, double, Backend> {
  std::uint32_t coarseRows = 0;
};

}  // namespace treacle
