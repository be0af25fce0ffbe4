#include "canvas.hpp"
#include "draw_axes.hpp"
#include "draw_panels.hpp"
#include "scale.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {

namespace {

constexpr Rgb gridColor{0.90, 0.90, 0.91};

/// The plot area in pixels, and the iterations and decades that it shows.
struct ResidualArea {
  double left, top, width, height;  // [px]
  double iterations = 1;
  int low = -1, high = 0;  // powers of ten

  Point at(double iteration, double residual) const {
    return {left + width * iteration / iterations, top + height * (high - std::log10(residual)) / (high - low)};
  }
};

/// Whether a logarithm shows it.
bool isVisible(double residual) { return residual > 0 && std::isfinite(residual); }

void setRange(ResidualArea& area, const std::vector<ConvergenceCurve>& curves) {
  double least = 1, most = 0;
  for (const ConvergenceCurve& curve : curves) {
    area.iterations = std::max(area.iterations, static_cast<double>(curve.iterations()));
    for (const double residual : curve.residuals)
      if (isVisible(residual)) least = std::min(least, residual), most = std::max(most, residual);
  }
  if (most == 0) return;
  area.high = static_cast<int>(std::ceil(std::log10(most) - 1e-9));
  area.low = std::min(area.high - 1, static_cast<int>(std::floor(std::log10(least) + 1e-9)));
}

void drawIterationAxis(Canvas& canvas, const ResidualArea& area, const Theme& theme) {
  const double bottom = area.top + area.height;
  for (const double tick : niceTicks(0, area.iterations, 9)) {
    if (tick != std::floor(tick)) continue;
    const double x = area.at(tick, 1).x;
    canvas.line({{x, area.top}, {x, bottom}}, gridColor, theme.thin());
    canvas.text({x, bottom + 18 * theme.unit}, fmt::format("{}", std::llround(tick)), theme.letters(),
                Align::Center, theme.ink);
  }
  canvas.text({area.left + area.width / 2, bottom + 48 * theme.unit}, "iterations", theme.letters(), Align::Center,
              theme.ink);
}

void drawResidualAxis(Canvas& canvas, const ResidualArea& area, const Theme& theme) {
  const int pitch = (area.high - area.low + 9) / 10;  // at most ten decades get a label
  for (int exponent = area.high; exponent >= area.low; exponent -= pitch) {
    const double y = area.at(0, std::pow(10.0, exponent)).y;
    canvas.line({{area.left, y}, {area.left + area.width, y}}, gridColor, theme.thin());
    canvas.text({area.left - 9 * theme.unit, y}, powerOfTen(exponent), theme.letters(), Align::Right, theme.ink);
  }
  canvas.text({area.left, area.top - 17 * theme.unit}, "|r| / |b|", theme.letters(), Align::Left, theme.ink);
}

void drawCurve(Canvas& canvas, const ResidualArea& area, const ConvergenceCurve& curve, Rgb color,
               const Theme& theme) {
  std::vector<Point> points;
  for (std::size_t k = 0; k < curve.residuals.size(); ++k)
    if (isVisible(curve.residuals[k])) points.push_back(area.at(static_cast<double>(k), curve.residuals[k]));
  canvas.line(points, color, 2.2 * theme.unit);
  // Iterations that stand apart get a mark.
  if (area.width > 12 * theme.unit * area.iterations || points.size() == 1)
    for (const Point& point : points) canvas.disc(point, 4 * theme.unit, color);
}

std::string millisecondsText(double seconds) { return fmt::format("{:.3g} ms", 1e3 * seconds); }

std::string legendText(const ConvergenceCurve& c) {
  const std::string outcome = c.outcome == "converged" ? "" : fmt::format(" ({})", c.outcome);
  return fmt::format("{}: {} iteration{}{}, {} and {} of set-up", c.solver, c.iterations(),
                     c.iterations() == 1 ? "" : "s", outcome, millisecondsText(c.solveSeconds),
                     millisecondsText(c.setupSeconds));
}

}  // namespace

void drawConvergence(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves,
                     const std::string& title, const std::string& remark) {
  if (curves.empty()) throw InputError("picture: no solver to draw a curve of");
  const Theme theme{1.0};
  constexpr int width = 1200;
  constexpr double legend = 620, line = 29;  // [px] from the top
  Canvas canvas(width, static_cast<int>(legend + line * static_cast<double>(curves.size())) + 20);
  drawHeading(canvas, title, remark, theme);

  ResidualArea area{105, 105, width - 145.0, 425};
  setRange(area, curves);
  drawIterationAxis(canvas, area, theme);
  drawResidualAxis(canvas, area, theme);
  canvas.frame({area.left, area.top}, {area.width, area.height}, theme.ink, theme.thin());
  double widest = 1;
  for (const ConvergenceCurve& curve : curves)
    widest = std::max(widest, canvas.textWidth(legendText(curve), theme.letters()));
  const double textLeft = area.left + 50;
  const double letters = theme.letters() * std::min(1.0, (width - 20 - textLeft) / widest);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Rgb color = curveColors[k % curveColors.size()];
    drawCurve(canvas, area, curves[k], color, theme);
    const double y = legend + line * static_cast<double>(k);
    canvas.line({{area.left, y}, {area.left + 36, y}}, color, 4 * theme.unit);
    canvas.text({textLeft, y}, legendText(curves[k]), letters, Align::Left, theme.ink);
  }
  canvas.writePng(path);
}

}  // namespace treacle
