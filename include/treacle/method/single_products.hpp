#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/method/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Products in single precision, for preconditioners; they need lists. "Per particle": activeCount elements, "per fluid
/// particle": fluidCount.

/// y = C q per fluid particle [q/m]; q per particle.
template <int D>
void pressureGradient(Context<Cuda>&, const MphPairs<D>&, std::span<const float> q, std::span<Vec<D, float>> y);

/// div = C^T u per particle [1/s], walls at rest; u per fluid particle.
template <int D>
void divergence(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D, float>> u, std::span<float> div);

}  // namespace treacle
