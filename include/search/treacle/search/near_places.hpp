#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace treacle {

/// The surroundings of a rectangle, which may be a line or a point, and of its periodic images.
template <int D>
struct Surroundings {
  Vec<D> corner{}, along{}, up{};  // [m]; unit vectors, zero where there is no edge
  double width = 0, height = 0;    // of the rectangle [m]
  double reach = 0;                // [m]
  int images = 1;
  Vec<D> shift[D == 2 ? 9 : 27]{};  // from a place to its images, the first to itself [m]

  static Surroundings of(const ProbePlaces& places, double reach, const Domain& domain) {
    Surroundings s;
    s.corner = resized<D>(places.corner);
    s.width = norm(places.along), s.height = norm(places.up);
    if (s.width > 0) s.along = resized<D>((1 / s.width) * places.along);
    if (s.height > 0) s.up = resized<D>((1 / s.height) * places.up);
    s.reach = reach;
    for (int k = 0; k < D; ++k) {
      if (!domain.periodic[static_cast<std::size_t>(k)]) continue;
      const double length = domain.max[k] - domain.min[k];
      for (int n = s.images, i = 0; i < n; ++i)
        for (const double way : {length, -length}) s.shift[s.images] = s.shift[i], s.shift[s.images++][k] += way;
    }
    return s;
  }

  TREACLE_HD bool holds(const Vec<D>& x) const {
    for (int i = 0; i < images; ++i) {
      const Vec<D> d = x + shift[i] - corner;
      const double a = std::fmin(std::fmax(dot(d, along), 0.0), width);
      const double b = std::fmin(std::fmax(dot(d, up), 0.0), height);
      if (norm2(d - a * along - b * up) <= reach * reach) return true;
    }
    return false;
  }
};

/// Of a few of the fluid and the walls, with what frames show.
template <int D, class Backend>
ParticleNumbers numbersOfSome(const Particles<D, Backend>& particles, std::size_t fluid, std::size_t walls) {
  ParticleNumbers numbers{fluid, walls};
  numbers.has = particles.has;
  return numbers;
}

/// Copies the own fluid and the first `walls` walls that are in the surroundings to the host, with their fields,
/// but without modes and surfaces. They keep their order.
/// Errors: std::bad_alloc.
template <int D, class Backend>
void copyNear(Context<Backend>&, const Surroundings<D>&, const Particles<D, Backend>& particles,
              std::uint32_t walls, Particles<D>& host);

}  // namespace treacle
