#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace treacle {

/// What a step does to velocities: root mean squares over the fluid [m/s].
struct StepChange {
  double speed = 0;   // |u^{k+1}|
  double change = 0;  // |u^{k+1} - u^k|

  /// Of sums of squares over so many particles.
  static StepChange mean(const std::array<double, 2>& sums, std::size_t particles) {
    if (particles == 0) return {};
    const auto count = static_cast<double>(particles);
    return {std::sqrt(sums[0] / count), std::sqrt(sums[1] / count)};
  }
};

/// What a fluid particle adds to the sums of squares; spans in the backend's memory, of the same length.
template <int D>
struct StepChangeTerms {
  static constexpr int count = 2;

  std::span<const Vec<D>> before, after;  // u^k, u^{k+1} [m/s]

  TREACLE_HD void add(std::size_t i, double* sums) const {
    sums[0] += norm2(after[i]);
    sums[1] += norm2(after[i] - before[i]);
  }
};

/// The order of the sums depends on the number of particles alone.
template <int D, class Backend>
StepChange stepChange(Context<Backend>&, const StepChangeTerms<D>&);

}  // namespace treacle
