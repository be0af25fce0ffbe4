#include "draw_panels.hpp"

#include "canvas.hpp"
#include "draw_axes.hpp"
#include "scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace treacle {
namespace {

/// A plot area and what it shows: [left, left + width] x [top, top + height] in pixels.
struct PanelArea {
  double left, top, width, height;  // [px]
  double start, end, low, high;     // of the axes

  Point at(double x, double y) const {
    return {left + width * (x - start) / (end - start), top + height * (high - y) / (high - low)};
  }
};

void setRange(PanelArea& area, const Panel& panel) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  area.low = infinity, area.high = -infinity;
  for (const PanelCurve& curve : panel.curves)
    for (const double y : curve.y)
      if (isDrawable(y)) area.low = std::min(area.low, y), area.high = std::max(area.high, y);
  if (area.low > area.high) area.low = area.high = 0;
  // Zero belongs to the picture where the values come near it.
  if (area.low > 0 && area.low < 0.5 * area.high) area.low = 0;
  const double size = area.high - area.low;
  const double margin =
      size > 1e-12 * std::abs(area.high) ? 0.06 * size : 0.1 * std::max(std::abs(area.high), 1e-30);
  area.high += margin;
  if (area.low != 0) area.low -= margin;
}

/// At most about four points per pixel column, the extremes among them: long runs draw as fast as short ones.
std::vector<Point> polyline(const PanelArea& area, const PanelCurve& curve) {
  const std::size_t columns = static_cast<std::size_t>(2 * area.width);
  const std::size_t group = std::max<std::size_t>(1, curve.x.size() / columns);
  std::vector<Point> values, points;
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    if (isDrawable(curve.x[k]) && isDrawable(curve.y[k])) values.push_back({curve.x[k], curve.y[k]});
  const auto add = [&](const Point& value) { points.push_back(area.at(value.x, value.y)); };
  const auto lower = [](const Point& a, const Point& b) { return a.y < b.y; };
  for (std::size_t begin = 0; begin < values.size(); begin += group) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = first + static_cast<std::ptrdiff_t>(std::min(group, values.size() - begin));
    if (group == 1) {
      add(*first);
      continue;
    }
    auto [least, most] = std::minmax_element(first, last, lower);
    if (most < least) std::swap(least, most);
    add(*least), add(*most);
  }
  return points;
}

void drawCommonAxis(Canvas& canvas, const PanelArea& area, const PanelAxis& axis, const Theme& theme,
                    bool labels) {
  const std::vector<double> ticks = niceTicks(area.start, area.end, 9);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 0;
  const Scale scale = axis.unit == "m" ? lengthScale(area.end, step) : scaleFor(ticks, axis.unit);
  const double bottom = area.top + area.height;
  for (const double tick : ticks) {
    const double x = area.at(tick, area.low).x;
    canvas.line({{x, area.top}, {x, bottom}}, {0.90, 0.90, 0.91}, theme.thin());
    if (labels)
      canvas.text({x, bottom + 18 * theme.unit}, scale.text(tick), theme.letters(), Align::Center, theme.ink);
  }
  if (labels)
    canvas.text({area.left + area.width / 2, bottom + 48 * theme.unit},
                fmt::format("{} [{}]", axis.label, scale.unit), theme.letters(), Align::Center, theme.ink);
}

void drawValueAxis(Canvas& canvas, const PanelArea& area, const Panel& panel, const Theme& theme) {
  const std::vector<double> ticks = niceTicks(area.low, area.high, 4);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 0;
  const Scale scale = panel.unit == "m" ? lengthScale(area.high, step) : scaleFor(ticks, panel.unit);
  for (const double tick : ticks) {
    const double y = area.at(area.start, tick).y;
    canvas.line({{area.left, y}, {area.left + area.width, y}}, {0.90, 0.90, 0.91}, theme.thin());
    canvas.text({area.left - 9 * theme.unit, y}, scale.text(tick), theme.letters(), Align::Right, theme.ink);
  }
  const std::string unit = scale.unit.empty() ? "" : fmt::format(" [{}]", scale.unit);
  canvas.text({area.left, area.top - 17 * theme.unit}, panel.label + unit, theme.letters(), Align::Left,
              theme.ink);
}

void drawCurves(Canvas& canvas, const PanelArea& area, const Panel& panel, const Theme& theme) {
  canvas.clip({area.left, area.top}, {area.width, area.height});
  for (const PanelCurve& curve : panel.curves) {
    const std::vector<Point> points = polyline(area, curve);
    if (points.size() == 1) canvas.disc(points[0], 4 * theme.unit, curve.color);
    canvas.line(points, curve.color, 2.2 * theme.unit);
  }
  canvas.unclip();
  double right = area.left + area.width;
  for (auto curve = panel.curves.rbegin(); curve != panel.curves.rend(); ++curve) {
    canvas.text({right, area.top - 17 * theme.unit}, curve->name, theme.letters(), Align::Right, curve->color,
                true);
    right -= canvas.textWidth(curve->name, theme.letters()) + 45 * theme.unit;
  }
}

}  // namespace

void drawPanels(const std::filesystem::path& path, const std::string& title, PanelAxis axis,
                const std::vector<Panel>& panels) {
  const Theme theme{1.0};
  constexpr double first = 105, pitch = 222, panelHeight = 165;  // [px]
  const int width = 1200, height = static_cast<int>(first + pitch * double(panels.size()) + 20);
  Canvas canvas(width, height);
  drawHeading(canvas, title, "", theme);
  if (!(axis.high > axis.low)) axis.high = axis.low + std::max(std::abs(axis.low), 1e-30);
  PanelArea area{105, 0, width - 145.0, panelHeight, axis.low, axis.high, 0, 1};
  for (std::size_t k = 0; k < panels.size(); ++k) {
    area.top = first + pitch * double(k);
    setRange(area, panels[k]);
    drawCommonAxis(canvas, area, axis, theme, k + 1 == panels.size());
    drawValueAxis(canvas, area, panels[k], theme);
    canvas.frame({area.left, area.top}, {area.width, area.height}, theme.ink, theme.thin());
    drawCurves(canvas, area, panels[k], theme);
  }
  canvas.writePng(path);
}

}  // namespace treacle
