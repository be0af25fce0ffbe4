#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/motion/shifting.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What an ISPH step does fluid particle by fluid particle, without neighbours; spans of own fluid in the
/// backend's memory.

/// p = 0 at the free surface and, where `cut`, where it is negative.
void settlePressure(Context<Cpu>&, std::span<const std::uint8_t> surface, bool cut, std::span<double> p);
void settlePressure(Context<Cuda>&, std::span<const std::uint8_t> surface, bool cut, std::span<double> p);

/// Whether no particle, of all processes, is at the free surface. Then the pressure equation has no Dirichlet
/// value: its matrix is singular, and pressures are known up to a constant, their level.
bool isClosed(Context<Cpu>&, std::span<const std::uint8_t> surface);
bool isClosed(Context<Cuda>&, std::span<const std::uint8_t> surface);

/// x less its mean, or less its least value, over all processes. The order of the sum is fixed.
enum class Level { Mean, Least };
void takeLevel(Context<Cpu>&, Level level, std::span<double> x);
void takeLevel(Context<Cuda>&, Level level, std::span<double> x);

/// transport: what the particles move with (Shifting); those at the free surface are not shifted.
template <int D>
void shiftedVelocity(Context<Cpu>&, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport);
template <int D>
void shiftedVelocity(Context<Cuda>&, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport);

/// The formula, for one particle.
TREACLE_HD inline double settledPressure(bool surface, bool cut, double p) {
  return surface || (cut && p < 0) ? 0 : p;
}
/// component k of v as a vector of numbers, and back.
template <int D>
void takeComponent(Context<Cpu>&, std::span<const Vec<D>> v, int k, std::span<double> x);
template <int D>
void takeComponent(Context<Cuda>&, std::span<const Vec<D>> v, int k, std::span<double> x);
template <int D>
void putComponent(Context<Cpu>&, std::span<const double> x, int k, std::span<Vec<D>> v);
template <int D>
void putComponent(Context<Cuda>&, std::span<const double> x, int k, std::span<Vec<D>> v);

}  // namespace treacle
