#pragma once

#include "canvas.hpp"
#include "view.hpp"

#include <vector>

namespace treacle {

/// Particles to draw, all positions finite.
struct Particle {
  Vec<3> position;  // [m]
  Rgb color;
};

/// All particles as flat discs, in the given order.
void drawFlat(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing);

/// Far ones first, shaded by the direction of the surface.
void drawSolid(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing);

/// Only surfaces that face the viewer, and of two behind each other the far one: one looks into a tank as if its
/// near walls were not there.
void drawOpened(Canvas& canvas, const View& view, const std::vector<Particle>& particles, double spacing);

}  // namespace treacle
