#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/floored_inverse.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Eigenvalues of M below this one count as this one: a particle that has neighbours on a line or none at all
/// knows nothing of the divergence across, and the fewer neighbours tell of a direction, the more the matrix that
/// made that exact would weigh each of them.
inline constexpr double leastMoment = 0.3;

/// The same, over the factor of B, for what acts of moments beside walls along which fluid slips: eigenvalues of B
/// are at most 1 over this there. The first row at a flat wall has 0.7.
inline constexpr double leastSlipMoment = 0.5;

/// B of a moment M = sum g d d^T = sum_k m_k v_k v_k^T [-], of neighbours at d with -e w' = g d:
/// B = min(1, a_min) sum_k v_k v_k^T / a_k with a_k = max(m_k, leastMoment), a_min the least of them. It has M's
/// eigenvectors, so that B M is symmetric; where no eigenvalue is below leastMoment, B M is the unit matrix but
/// for the factor, which is 1 or the least eigenvalue: none of B's own is above 1.
template <int D>
TREACLE_HD inline SymmetricBlock<D> renormalisationOf(const SymmetricBlock<D>& moment) {
  return flooredInverse(moment, leastMoment, true);
}

/// B of every fluid particle from its neighbours within h_p, walls among them. It makes C^T u, minus the
/// divergence, exact for velocities that are linear in space, whatever stands around a particle (Randles, Libersky
/// 1996; Bonet, Lok 1999), but for a factor, which is as if the particle's bulk viscosity were less.
template <int D, class Backend>
void renormalisation(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>> b);

}  // namespace treacle
