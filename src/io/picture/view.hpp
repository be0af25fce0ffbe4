#pragma once

#include "box.hpp"
#include "canvas.hpp"
#include "treacle/core/vec.hpp"

namespace treacle {

/// Parallel projection: orthonormal directions of the picture in space, and its place on the canvas.
struct View {
  Vec<3> right{1, 0, 0}, up{0, 1, 0}, toViewer{0, 0, 1};
  double scale = 1;    // [px/m]
  Point origin{0, 0};  // where the origin of space is on the canvas [px]

  Point operator()(const Vec<3>& x) const {
    return {origin.x + scale * dot(right, x), origin.y - scale * dot(up, x)};
  }
};

/// The axis of space that points up, and which way: against the main axis of gravity; along z without gravity.
struct Upward {
  int axis = 2;
  double sign = 1;
};
Upward upward(const Vec<3>& gravity);

/// From above and the side. The first horizontal axis runs to the right.
View obliqueView(const Vec<3>& gravity);

/// Where the box lies in the picture, with `scale` 1 and `origin` 0.
struct PictureExtent {
  double left = 0, right = 0, bottom = 0, top = 0;  // [m], y up
};
PictureExtent extentOf(const Box& box, const View& view);

}  // namespace treacle
