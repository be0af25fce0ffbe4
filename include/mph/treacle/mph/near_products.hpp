#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Particles per slice of the lists.
inline constexpr unsigned nearSlice = 32;

/// Products with C and C^T on a device from lists of each particle's own neighbours within h_p: a third of what
/// the lists of clusters hold in 3D, and these products are short of time, not of memory. Needs the lists of
/// clusters.
template <int D>
class NearProducts {
 public:
  /// Makes the lists; `pairs` must outlive the products.
  void prepare(Context<Cuda>&, const MphPairs<D>& pairs);

  /// y += C q per fluid particle; q per particle.
  void addPressureGradient(Context<Cuda>&, std::span<const double> q, std::span<Vec<D>> y) const;

  /// q = lambda C^T u per particle, walls at rest; u per fluid particle. For pairs with B: without it
  /// ViscosityAndDivergence has this sum.
  void bulkStress(Context<Cuda>&, std::span<const Vec<D>> u, std::span<double> q) const;

  /// Positions in units of 2^-32 of the domain's length: differences are exact, and those across periodic ends
  /// come out right by themselves. 4 numbers per particle; the last one has the bits of the scale of its viscosity
  /// in single precision.
  std::span<const std::int32_t> fixedPosition() const { return fixedPosition_; }

  std::span<const std::uint64_t> sliceStart() const { return sliceStart_; }
  std::span<const std::uint32_t> entries() const { return entry_; }

  std::size_t bytes() const { return sliceStart_.bytes() + entry_.bytes() + fixedPosition_.bytes(); }

 private:
  const MphPairs<D>* pairs_ = nullptr;
  // Slices of nearSlice particles, each with as many rows of that many entries as its longest list; shorter ones
  // are filled up with the particle itself, with which every term is zero.
  Buffer<std::uint64_t, Cuda> sliceStart_;  // in rows
  Buffer<std::uint32_t, Cuda> entry_;
  Buffer<std::int32_t, Cuda> fixedPosition_;
};

}  // namespace treacle
