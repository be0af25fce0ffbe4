#pragma once

namespace treacle {

/// A colour, components 0 … 1 (sRGB).
struct Rgb {
  double red = 0, green = 0, blue = 0;

  constexpr Rgb scaled(double factor) const { return {red * factor, green * factor, blue * factor}; }
};

/// The perceptually uniform colour map "viridis" at t in [0, 1] (clamped; not a number gives grey).
Rgb viridis(double t);

}  // namespace treacle
