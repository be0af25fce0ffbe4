#include "view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {

namespace {

Vec<3> normalized(const Vec<3>& a) { return a * (1 / norm(a)); }

}  // namespace

Upward upward(const Vec<3>& gravity) {
  Upward result;
  for (int k = 0; k < 3; ++k)
    if (std::abs(gravity[k]) > std::abs(gravity[result.axis])) result.axis = k;
  if (gravity[result.axis] > 0) result.sign = -1;
  return result;
}

View obliqueView(const Vec<3>& gravity) {
  const Upward vertical = upward(gravity);
  Vec<3> up{}, along{};
  up[vertical.axis] = vertical.sign;
  along[vertical.axis == 0 ? 1 : 0] = 1;
  const Vec<3> away = cross(up, along);
  View view;
  view.toViewer = normalized(0.50 * along - 0.75 * away + 0.45 * up);
  view.right = normalized(cross(up, view.toViewer));
  view.up = cross(view.toViewer, view.right);
  return view;
}

PictureExtent extentOf(const Box& box, const View& view) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  PictureExtent e{infinity, -infinity, infinity, -infinity};
  for (int bits = 0; bits < 8; ++bits) {
    const double x = dot(view.right, box.corner(bits)), y = dot(view.up, box.corner(bits));
    e.left = std::min(e.left, x), e.right = std::max(e.right, x);
    e.bottom = std::min(e.bottom, y), e.top = std::max(e.top, y);
  }
  return e;
}

}  // namespace treacle
