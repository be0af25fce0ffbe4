#pragma once

#include "treacle/core/cuda.hpp"

#include <cstddef>

namespace treacle {

/// terms.set(i) for i < count. It is instantiated for the terms at the end of step/each_particle.hpp.
template <class Terms, class Backend>
void setEach(Context<Backend>&, const Terms& terms, std::size_t count);

}  // namespace treacle
