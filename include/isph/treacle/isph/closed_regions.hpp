#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/isph/isph_pairs.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Bodies of fluid without a free surface, such as fluid that fills a box. Particles whose pressures depend on
/// each other belong to one region. In a closed region the pressure equation has no Dirichlet value: its matrix is
/// singular, and pressures are known up to a constant, their level. All arrays are in the backend's memory.
template <class Backend>
struct ClosedRegions {
  std::vector<std::uint32_t> labels;            // of the closed regions of all processes, ascending; none is 0
  Buffer<std::uint32_t, Backend> label;         // where some(), per particle with ghosts: 0 where it is in none
  Buffer<std::uint32_t, Backend> parent, next;  // to find them

  bool some() const { return !labels.empty(); }
  std::size_t bytes() const { return label.bytes() + parent.bytes() + next.bytes(); }
};

/// Finds those of the fluid of all processes. `surface` holds a Place per own particle. Collective. One pass over
/// the first neighbours is all where each particle has a way up to a free surface.
template <int D, class Backend>
void findClosedRegions(Context<Backend>&, const IsphPairs<D>& pairs, std::span<const std::uint8_t> surface,
                       ClosedRegions<Backend>& regions);

/// x less its mean or its least value in each region; x stays as it is elsewhere. `x`: per own particle. The order
/// of the sum is fixed. Collective.
enum class Level { Mean, Least };
template <class Backend>
void takeLevels(Context<Backend>&, const ClosedRegions<Backend>& regions, Level level, std::span<double> x);

/// Sets `missing` [-], per own particle, to zero in all regions: what lacks there is not a free surface.
template <class Backend>
void fillRegions(Context<Backend>&, const ClosedRegions<Backend>& regions, std::span<float> missing);

}  // namespace treacle
