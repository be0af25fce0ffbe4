#pragma once

#include "treacle/model/particles/particles.hpp"

#include <cstddef>
#include <cstdint>

namespace treacle {

/// Calls f(one value per own fluid particle) for every field that fluid has, each mode being one.
template <int D, class Backend, class F>
void forEachFieldOfFluid(Particles<D, Backend>& p, F&& f) {
  const auto whole = [&](auto& field) { f(field.data()); };
  forEachSharedFieldOf(whole, p);
  forEachFluidFieldOf(whole, p);
  for (std::uint32_t m = 0; m < p.modeCount(); ++m) f(p.modes.vectors.data() + std::size_t{m} * p.fluidCount);
}

}  // namespace treacle
