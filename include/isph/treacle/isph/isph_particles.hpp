#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/motion/shifting.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What an ISPH step does fluid particle by fluid particle, without neighbours; spans of own fluid in the
/// backend's memory.

/// sum = p + q
template <class Backend>
void addPressures(Context<Backend>&, std::span<const double> p, std::span<const double> q, std::span<double> sum);

/// p = `outside` for free particles and, where `cut`, 0 where p is less than both 0 and that. `surface` holds a
/// Place each. `outside`: IsphPairs::outside, or null where it is 0.
template <class Backend>
void settlePressure(Context<Backend>&, std::span<const std::uint8_t> surface, const double* outside, bool cut,
                    std::span<double> p);

/// transport: what the particles move with (Shifting); those at the free surface are not shifted.
template <int D, class Backend>
void shiftedVelocity(Context<Backend>&, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport);

/// transport: cut to velocities that lead at most longestShift away from where `velocity` does. `timeStep` in s.
template <int D, class Backend>
void limitTransport(Context<Backend>&, double spacing, double timeStep, std::span<const Vec<D>> velocity,
                    std::span<Vec<D>> transport);

/// component k of v as a vector of numbers, and back.
template <int D, class Backend>
void takeComponent(Context<Backend>&, std::span<const Vec<D>> v, int k, std::span<double> x);
template <int D, class Backend>
void putComponent(Context<Backend>&, std::span<const double> x, int k, std::span<Vec<D>> v);

}  // namespace treacle
