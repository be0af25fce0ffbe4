#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// A vector for each column of particles in a nozzle, which is found by where a particle stands. The columns stand
/// on a lattice across the direction of the nozzle.
template <int D>
struct NozzleColumns {
  std::uint8_t body = 0;         // index into Case::bodies
  double spacing = 1;            // [m]
  Vec<D> first{};                // a place in the first column of the lattice [m]
  Vec<D> period{};               // of the domain, 0 on open axes [m]
  Vec<D> axes[D - 1]{};          // of the lattice, of length 1
  int counts[D - 1]{};           // of its columns along them; all 1 where one vector is for all particles
  std::span<const Vec<D>> each;  // per place of the lattice, along the last axis first; in the backend's memory

  /// The place in the lattice of a particle at x [m].
  TREACLE_HD std::size_t placeOf(const Vec<D>& x) const {
    Vec<D> d = x - first;
    for (int k = 0; k < D; ++k)
      if (period[k] > 0) d[k] -= period[k] * std::rint(d[k] / period[k]);
    int place = 0;
    for (int k = 0; k < D - 1; ++k) {
      const double along = std::rint(dot(d, axes[k]) / spacing);
      place = place * counts[k] + static_cast<int>(std::fmin(std::fmax(along, 0.0), counts[k] - 1.0));
    }
    return static_cast<std::size_t>(place);
  }
};

}  // namespace treacle
