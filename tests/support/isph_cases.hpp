#pragma once

#include "support/isph_scene.hpp"
#include "treacle/step/run/simulation.hpp"

namespace treacle::test {

/// Where the corner of a tank stands and how thick its walls are, in spacings.
inline constexpr double tankCorner = 6, tankWall = 3;

/// An open tank, `width` spacings wide along the axes across, that holds water to a depth of `depth` spacings.
Case tankCase(int dimensions, double width, double depth);

template <int D>
Particles<D> created(const Case& c);

template <int D>
Particles<D> copyOf(const Particles<D>& from);

/// Mean of f(i) over the fluid.
template <int D, class F>
auto fluidMean(const Particles<D>& p, F&& f) {
  auto sum = f(0u) * 0.0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) sum += f(i) * (1.0 / p.fluidCount);
  return sum;
}
template <int D>
Vec<D> meanVelocity(const Particles<D>& p);
template <int D>
Vec<D> centreOfMass(const Particles<D>& p);

/// All fields of particles by id.
template <int D>
bool sameBits(const Particles<D>& a, const Particles<D>& b);

}  // namespace treacle::test
