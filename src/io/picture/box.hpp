#pragma once

#include "treacle/core/vec.hpp"

#include <vector>

namespace treacle {

struct Box {
  Vec<3> min{}, max{};  // [m]

  /// Corner with the maximum along axis k where bit k is set.
  Vec<3> corner(int bits) const;
  /// Smallest box that holds both.
  Box joined(const Box& other) const;
  double longestSide() const;  // [m]
};

/// Smallest box around all positions, widened by `margin` on each side [m]; without positions min is +inf, max
/// -inf.
Box boundsOf(const std::vector<Vec<3>>& position, double margin);

}  // namespace treacle
