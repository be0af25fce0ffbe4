#include "canvas.hpp"
#include "draw_axes.hpp"
#include "scale.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace treacle {

namespace {

struct Curve {
  std::string name;
  std::function<double(const HistoryRow&)> value;
  Rgb color;
};

struct Panel {
  std::string label, unit;
  std::vector<Curve> curves;
};

std::vector<Panel> panelsOf(const std::vector<HistoryRow>& rows) {
  constexpr Rgb blue{0.13, 0.36, 0.60}, orange{0.85, 0.42, 0.08}, green{0.10, 0.50, 0.35},
      purple{0.42, 0.20, 0.52};
  std::vector<Panel> panels = {
      {"iterations", "", {{"", [](const HistoryRow& r) { return double(r.iterations); }, blue}}},
      {"kinetic energy", "J", {{"", [](const HistoryRow& r) { return r.kineticEnergy; }, orange}}},
      {"potential energy", "J", {{"", [](const HistoryRow& r) { return r.potentialEnergy; }, green}}},
      {"extent",
       "m",
       {{"front x", [](const HistoryRow& r) { return r.frontX; }, blue},
        {"top", [](const HistoryRow& r) { return r.top; }, orange}}},
      {"largest speed", "m/s", {{"", [](const HistoryRow& r) { return r.maxSpeed; }, purple}}}};
  if (std::ranges::any_of(rows, [](const HistoryRow& r) { return r.particles > 0; }))
    panels.push_back({"mass in and out",
                      "kg",
                      {{"in", [](const HistoryRow& r) { return r.inflow.mass; }, blue},
                       {"out", [](const HistoryRow& r) { return r.outflow.mass; }, orange}}});
  return panels;
}

/// A plot area and what it shows: [left, left + width] x [top, top + height] in pixels.
struct Area {
  double left, top, width, height;       // [px]
  double startTime, endTime, low, high;  // of the axes

  Point at(double time, double value) const {
    return {left + width * (time - startTime) / (endTime - startTime),
            top + height * (high - value) / (high - low)};
  }
};

void setRange(Area& area, const Panel& panel, const std::vector<HistoryRow>& rows) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  area.low = infinity, area.high = -infinity;
  for (const Curve& curve : panel.curves)
    for (const HistoryRow& row : rows)
      if (const double v = curve.value(row); isDrawable(v))
        area.low = std::min(area.low, v), area.high = std::max(area.high, v);
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
std::vector<Point> polyline(const Area& area, const Curve& curve, const std::vector<HistoryRow>& rows) {
  const std::size_t columns = static_cast<std::size_t>(2 * area.width);
  const std::size_t group = std::max<std::size_t>(1, rows.size() / columns);
  std::vector<Point> values, points;
  for (const HistoryRow& row : rows)
    if (isDrawable(curve.value(row))) values.push_back({row.time, curve.value(row)});
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

void drawTimeAxis(Canvas& canvas, const Area& area, const Theme& theme, bool labels) {
  const std::vector<double> ticks = niceTicks(area.startTime, area.endTime, 9);
  const Scale scale = scaleFor(ticks, "s");
  const double bottom = area.top + area.height;
  for (const double tick : ticks) {
    const double x = area.at(tick, area.low).x;
    canvas.line({{x, area.top}, {x, bottom}}, {0.90, 0.90, 0.91}, theme.thin());
    if (labels)
      canvas.text({x, bottom + 18 * theme.unit}, scale.text(tick), theme.letters(), Align::Center, theme.ink);
  }
  if (labels)
    canvas.text({area.left + area.width / 2, bottom + 48 * theme.unit}, fmt::format("time [{}]", scale.unit),
                theme.letters(), Align::Center, theme.ink);
}

void drawValueAxis(Canvas& canvas, const Area& area, const Panel& panel, const Theme& theme) {
  const std::vector<double> ticks = niceTicks(area.low, area.high, 4);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 0;
  const Scale scale = panel.unit == "m" ? lengthScale(area.high, step) : scaleFor(ticks, panel.unit);
  for (const double tick : ticks) {
    const double y = area.at(area.startTime, tick).y;
    canvas.line({{area.left, y}, {area.left + area.width, y}}, {0.90, 0.90, 0.91}, theme.thin());
    canvas.text({area.left - 9 * theme.unit, y}, scale.text(tick), theme.letters(), Align::Right, theme.ink);
  }
  const std::string unit = scale.unit.empty() ? "" : fmt::format(" [{}]", scale.unit);
  canvas.text({area.left, area.top - 17 * theme.unit}, panel.label + unit, theme.letters(), Align::Left,
              theme.ink);
}

void drawCurves(Canvas& canvas, const Area& area, const Panel& panel, const std::vector<HistoryRow>& rows,
                const Theme& theme) {
  canvas.clip({area.left, area.top}, {area.width, area.height});
  for (const Curve& curve : panel.curves) {
    const std::vector<Point> points = polyline(area, curve, rows);
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

void drawHistory(const std::filesystem::path& path, const std::vector<HistoryRow>& rows,
                 const std::string& title) {
  if (rows.empty()) throw InputError("picture: the history holds no steps");
  for (const HistoryRow& row : rows)
    if (!isDrawable(row.time))
      throw InputError(fmt::format("picture: step {} is at t = {} s", row.step, row.time));
  const Theme theme{1.0};
  const std::vector<Panel> all = panelsOf(rows);
  constexpr double first = 105, pitch = 222, panelHeight = 165;  // [px]
  const int width = 1200, height = static_cast<int>(first + pitch * double(all.size()) + 20);
  Canvas canvas(width, height);
  drawHeading(canvas, title, "", theme);

  Area area{105, 0, width - 145.0, panelHeight, rows.front().time, rows.back().time, 0, 1};
  if (!(area.endTime > area.startTime)) area.endTime = area.startTime + std::max(std::abs(area.startTime), 1e-30);
  for (std::size_t k = 0; k < all.size(); ++k) {
    area.top = first + pitch * double(k);
    setRange(area, all[k], rows);
    drawTimeAxis(canvas, area, theme, k + 1 == all.size());
    drawValueAxis(canvas, area, all[k], theme);
    canvas.frame({area.left, area.top}, {area.width, area.height}, theme.ink, theme.thin());
    drawCurves(canvas, area, all[k], rows, theme);
  }
  canvas.writePng(path);
}

}  // namespace treacle
