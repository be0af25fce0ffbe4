#pragma once

#include "support/loaded_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace treacle::test {

/// Runs five steps: temperatures stay between their extremes of the step before, and those come together, in the
/// end to less than the share `most` of their distance at the start.
inline void expectNoNewExtremes(const LoadedWalls<2>& start, double most) {
  Simulation<2> s = start.simulation<Cpu>();
  const auto range = [&] {
    const auto& T = s.particles().temperature;
    return std::pair{*std::min_element(T.begin(), T.end()), *std::max_element(T.begin(), T.end())};
  };
  const auto first = range();
  for (int k = 0; k < 5; ++k) {
    const auto before = range();
    s.advance();
    const auto after = range();
    EXPECT_GE(after.first, before.first - 1e-6);
    EXPECT_LE(after.second, before.second + 1e-6);
  }
  EXPECT_LT(range().second - range().first, most * (first.second - first.first));
}

}  // namespace treacle::test
