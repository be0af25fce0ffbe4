#include "draw_axes.hpp"

#include "scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace treacle {

namespace {

constexpr std::array<const char*, 3> axisNames = {"x", "y", "z"};

/// One axis: its straight line in space and the side of it in the picture on which marks and labels stand.
struct Axis {
  int k;                  // along this direction of space
  Vec<3> start;           // the axis leaves here towards growing x_k
  Point outward;          // unit vector in the picture
  double labelsFrom = 0;  // share of the length that stays free of marks for those of another axis
};

Point moved(Point p, Point direction, double by) { return {p.x + by * direction.x, p.y + by * direction.y}; }

Align alignment(Point outward) {
  return outward.x < -0.3 ? Align::Right : outward.x > 0.3 ? Align::Left : Align::Center;
}

void drawAxis(Canvas& canvas, const View& view, const Box& box, const Axis& axis, const Theme& theme) {
  const auto at = [&](double value) {
    Vec<3> x = axis.start;
    x[axis.k] = value;
    return view(x);
  };
  const double low = box.min[axis.k], high = box.max[axis.k];
  const Point from = at(low), to = at(high);
  const double length = std::hypot(to.x - from.x, to.y - from.y);  // [px]
  const std::vector<double> ticks = niceTicks(low, high, std::clamp(int(length / (95 * theme.unit)), 2, 8));
  const Vec<3> size = box.max - box.min;
  const Scale scale =
      lengthScale(*std::max_element(size.v, size.v + 3), ticks.size() > 1 ? ticks[1] - ticks[0] : 0);

  const bool sideways = axis.outward.y == 0;
  double widest = 0.7 * theme.letters();
  for (const double tick : ticks) {
    if (tick < low + axis.labelsFrom * (high - low)) continue;
    const Point foot = at(tick);
    canvas.line({foot, moved(foot, axis.outward, theme.tick())}, theme.ink, theme.thin());
    const std::string label = scale.text(tick);
    canvas.text(moved(foot, axis.outward, theme.tick() + (sideways ? 5 : 15) * theme.unit), label, theme.letters(),
                alignment(axis.outward), theme.ink);
    widest = std::max(widest, canvas.textWidth(label, theme.letters()) * std::abs(axis.outward.x));
  }
  const Point middle = at((low + high) / 2);
  const double away = theme.tick() + widest + (sideways ? 24 : 32) * theme.unit;
  canvas.text(moved(middle, axis.outward, away), std::string(axisNames[axis.k]) + " [" + scale.unit + "]",
              theme.letters(), sideways ? Align::Center : alignment(axis.outward), theme.ink, false, sideways);
}

int nearestCorner(const View& view) {
  int bits = 0;
  for (int k = 0; k < 3; ++k)
    if (view.toViewer[k] > 0) bits |= 1 << k;
  return bits;
}

/// Calls f(corner, other corner) for the edges that do or do not touch the corner next to the viewer.
template <class F>
void forEachEdge(const View& view, bool inFront, F f) {
  const int nearest = nearestCorner(view);
  for (int k = 0; k < 3; ++k)
    for (int bits = 0; bits < 8; ++bits)
      if (!(bits >> k & 1)) {
        const int other = bits | 1 << k;
        if ((bits == nearest || other == nearest) == inFront) f(bits, other);
      }
}

/// The horizontal edge along k at the bottom, on the viewer's side.
Axis horizontalAxis(const View& view, const Box& box, const Upward& vertical, int k) {
  const int other = 3 - k - vertical.axis;
  int bits = nearestCorner(view) & (1 << other);
  if (vertical.sign < 0) bits |= 1 << vertical.axis;
  Vec<3> out{};
  out[other] = view.toViewer[other] > 0 ? 1 : -1;
  const Point direction{dot(view.right, out), -dot(view.up, out)};
  const double size = std::hypot(direction.x, direction.y);
  return {k, box.corner(bits), {direction.x / size, direction.y / size}};
}

/// The vertical edge at the left of the picture.
Axis verticalAxis(const View& view, const Box& box, const Upward& vertical) {
  int leftmost = -1;
  for (int bits = 0; bits < 8; ++bits) {
    if (bits >> vertical.axis & 1) continue;
    if (leftmost < 0 || view(box.corner(bits)).x < view(box.corner(leftmost)).x) leftmost = bits;
  }
  return {vertical.axis, box.corner(leftmost), {-1, 0}, 0.03};
}

}  // namespace

void drawHeading(Canvas& canvas, const std::string& title, const std::string& remark, const Theme& theme) {
  const double size = 1.2 * theme.letters(), margin = 24 * theme.unit, y = 36 * theme.unit;
  const double room = canvas.width() - 3 * margin - canvas.textWidth(remark, size);
  const double boldWidth = 1.15 * canvas.textWidth(title, size);
  canvas.text({margin, y}, title, size * std::min(1.0, room / std::max(boldWidth, 1.0)), Align::Left, theme.ink,
              true);
  canvas.text({canvas.width() - margin, y}, remark, size, Align::Right, theme.ink);
}

void drawPlaneAxes(Canvas& canvas, const View& view, const Box& box, const Theme& theme) {
  const Point topLeft = view({box.min[0], box.max[1], 0}), bottomRight = view({box.max[0], box.min[1], 0});
  canvas.frame(topLeft, {bottomRight.x - topLeft.x, bottomRight.y - topLeft.y}, theme.ink, theme.thin());
  drawAxis(canvas, view, box, {0, box.min, {0, 1}}, theme);
  drawAxis(canvas, view, box, {1, box.min, {-1, 0}}, theme);
}

void drawBoxBehind(Canvas& canvas, const View& view, const Box& box, const Upward& vertical, const Theme& theme) {
  forEachEdge(view, false, [&](int a, int b) {
    canvas.line({view(box.corner(a)), view(box.corner(b))}, theme.faint, theme.thin());
  });
  for (int k = 0; k < 3; ++k)
    drawAxis(canvas, view, box,
             k == vertical.axis ? verticalAxis(view, box, vertical) : horizontalAxis(view, box, vertical, k),
             theme);
}

void drawBoxInFront(Canvas& canvas, const View& view, const Box& box, const Theme& theme) {
  forEachEdge(view, true, [&](int a, int b) {
    canvas.line({view(box.corner(a)), view(box.corner(b))}, theme.faint, theme.thin(), 0.45);
  });
}

}  // namespace treacle
