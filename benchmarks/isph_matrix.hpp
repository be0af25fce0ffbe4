#pragma once

#include "linear/scalar_product.hpp"
#include "treacle/isph/isph_pressure_terms.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// The matrix of ISPH's pressure equation [O23 eq. (11)] as a user of the CUDA libraries has it: compressed rows
/// of double precision with 32-bit indices, made from the ranges of the search cells; columns in the order of the
/// cells around a particle. Rows of known pressure are those of the identity; no other row refers to them.
/// `inverse`: 1 / A_ii, zero where the pressure is known. Errors: RunError for more nonzeros than 32 bits count.
template <int D>
void assemblePressure(Context<Cuda>&, const IsphPairs<D>& pairs, const PressureRow<D>& row, ScalarCsr& a,
                      Buffer<double, Cuda>& inverse);

/// x = 0 where the pressure is known: with that all methods start from the same residual.
template <int D>
void clearKnown(Context<Cuda>&, const PressureRow<D>& row, std::span<double> x);

struct PairCounts {
  std::uint64_t all, near;
};

/// Fluid neighbours of all fluid particles, themselves included, within the kernel's radius and within `near` [m].
template <int D>
PairCounts countPairs(Context<Cuda>&, const IsphPairs<D>& pairs, double near);

}  // namespace treacle
