#pragma once

#include "treacle/io/frames/frame.hpp"

#include <random>

namespace treacle::test {

/// Random particles in a box of 20 mm, all fields filled with different values.
inline Frame sampleFrame(int dimensions, std::uint32_t count, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Frame frame;
  frame.dimensions = dimensions;
  frame.time = 0.1 + 1e-17 * seed;
  for (std::uint32_t i = 0; i < count; ++i) {
    Vec<3> x{}, u{};
    for (int k = 0; k < dimensions; ++k) x[k] = 0.02 * unit(generator), u[k] = unit(generator) - 0.5;
    frame.position.push_back(x);
    frame.velocity.push_back(u);
    frame.pressure.push_back(1e4 * (unit(generator) - 0.5));
    frame.numberDensity.push_back(1 + 0.01 * unit(generator));
    frame.nearestDistance.push_back(unit(generator));
    frame.material.push_back(static_cast<std::int32_t>(i % 3));
    frame.body.push_back(static_cast<std::int32_t>(i % 255));
    frame.id.push_back(4000000000u - i);
  }
  return frame;
}

}  // namespace treacle::test
