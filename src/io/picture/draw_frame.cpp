#include "draw_axes.hpp"
#include "draw_particles.hpp"
#include "scale.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {

namespace {

struct FieldValues {
  std::string label, unit, key;  // the key in case files
  std::vector<double> values;
  bool fromZero = false;
};

FieldValues fieldValues(const Frame& fluid, PictureField field, const std::string& state) {
  if (field == PictureField::State) {
    const auto found = std::ranges::find(fluid.states, state, &FrameState::name);
    return {state, "", state, found == fluid.states.end() ? std::vector<double>{} : found->values};
  }
  if (field == PictureField::Pressure) return {"pressure", "Pa", "pressure", fluid.pressure};
  if (field == PictureField::NumberDensity) return {"number density", "", "number_density", fluid.numberDensity};
  if (field == PictureField::NearestDistance)
    return {"nearest distance / spacing", "", "nearest_distance", fluid.nearestDistance};
  if (field == PictureField::Material)
    return {"material", "", "material", {fluid.material.begin(), fluid.material.end()}};
  if (field == PictureField::Temperature) return {"temperature", "K", "temperature", fluid.temperature};
  if (field == PictureField::ShearRate) return {"shear rate", "1/s", "shear_rate", fluid.shearRate, true};
  if (field == PictureField::DynamicViscosity) {
    FieldValues viscosity{"log10 of viscosity / Pa s", "", "dynamic_viscosity", {}};
    for (const double mu : fluid.dynamicViscosity) viscosity.values.push_back(std::log10(mu));
    return viscosity;
  }
  FieldValues speed{"speed", "m/s", "velocity", {}, true};
  for (const Vec<3>& u : fluid.velocity) speed.values.push_back(norm(u));
  return speed;
}

struct Range {
  double low = 0, high = 1;
};

Range colorRange(const FieldValues& field, const PictureOptions& options) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Range range{infinity, -infinity};
  for (const double value : field.values)
    if (isDrawable(value)) range = {std::min(range.low, value), std::max(range.high, value)};
  if (range.low > range.high) range = {0, 0};
  if (field.fromZero) range.low = 0;
  if (options.minimum) range.low = *options.minimum;
  if (options.maximum) range.high = *options.maximum;
  // A uniform field: any width does, the bar has to show the value.
  if (!(range.high > range.low)) range.high = range.low + (range.low == 0 ? 1 : std::abs(range.low));
  return range;
}

/// Farther from the origin than this positions are no multiples of a spacing, and a picture shows nothing.
bool isInReach(const Vec<3>& x, double spacing) {
  const double farthest = std::min(1e15 * spacing, 1e150);  // [m]
  return std::all_of(x.v, x.v + 3, [&](double component) { return std::abs(component) <= farthest; });
}

/// Particles whose position can be drawn, with `color(i)`.
template <class Color>
std::vector<Particle> drawable(const Frame& frame, double spacing, Color color) {
  std::vector<Particle> particles;
  particles.reserve(frame.position.size());
  for (std::size_t i = 0; i < frame.position.size(); ++i)
    if (isInReach(frame.position[i], spacing)) particles.push_back({frame.position[i], color(i)});
  return particles;
}

Box boundsOf(const std::vector<Particle>& particles, double margin) {
  std::vector<Vec<3>> position;
  position.reserve(particles.size());
  for (const Particle& p : particles) position.push_back(p.position);
  return boundsOf(position, margin);
}

/// Where things are on the canvas [px].
struct Layout {
  int height;
  double left, top, plotWidth, plotHeight;
  double barLeft, barWidth;
};

Layout layoutFor(const PictureExtent& extent, int width, bool solid, const Theme& theme) {
  const double u = theme.unit, aspect = (extent.top - extent.bottom) / (extent.right - extent.left);
  Layout layout;
  layout.left = (solid ? 105 : 100) * u;
  layout.top = 70 * u;
  layout.barWidth = 26 * u;
  layout.plotWidth = width - layout.left - 190 * u;
  // Flat and tall pictures get a canvas that still has room for the bar and fits a screen.
  layout.plotHeight = layout.plotWidth * std::clamp(aspect, 0.25, 1.0);
  layout.plotWidth = std::min(layout.plotWidth, layout.plotHeight / aspect);
  layout.barLeft = layout.left + layout.plotWidth + 45 * u;
  layout.height = static_cast<int>(layout.top + layout.plotHeight + (solid ? 60 : 85) * u);
  return layout;
}

void drawColorBar(Canvas& canvas, const Layout& layout, const Range& range, const FieldValues& field,
                  const Theme& theme) {
  const double height = std::min(layout.plotHeight, 520 * theme.unit);
  const double top = layout.top + (layout.plotHeight - height) / 2 + 12 * theme.unit;
  const double barHeight = height - 24 * theme.unit;
  for (int y = 0; y < int(barHeight); ++y)
    canvas.rectangle({layout.barLeft, top + y}, {layout.barWidth, 1.5}, viridis(1 - (y + 0.5) / barHeight));
  canvas.frame({layout.barLeft, top}, {layout.barWidth, barHeight}, theme.ink, theme.thin());
  const std::vector<double> ticks = niceTicks(range.low, range.high, 6);
  const Scale scale = scaleFor(ticks, field.unit);
  const double right = layout.barLeft + layout.barWidth;
  double widest = 0;
  for (const double tick : ticks) {
    const double y = top + barHeight * (range.high - tick) / (range.high - range.low);
    canvas.line({{right, y}, {right + theme.tick(), y}}, theme.ink, theme.thin());
    canvas.text({right + 12 * theme.unit, y}, scale.text(tick), theme.letters(), Align::Left, theme.ink);
    widest = std::max(widest, canvas.textWidth(scale.text(tick), theme.letters()));
  }
  const std::string unit = scale.unit.empty() ? "" : fmt::format(" [{}]", scale.unit);
  canvas.text({right + 38 * theme.unit + widest, top + barHeight / 2}, field.label + unit, theme.letters(),
              Align::Center, theme.ink, false, true);
}

void check(const Frame& fluid, const FieldValues& field, const PictureOptions& options) {
  if (!(options.spacing > 0)) throw InputError("picture: the particle spacing must be greater than 0");
  if (options.width < 200 || options.width > 16384)
    throw InputError(fmt::format("picture: width {} px, expected 200 to 16384", options.width));
  if (field.values.size() != fluid.position.size())
    throw InputError(
        fmt::format("picture: the frame does not hold '{}' (see output.fields of the case)", field.key));
}

}  // namespace

std::size_t drawFrame(const std::filesystem::path& path, const Frame& fluid, const Frame& walls,
                      const PictureOptions& options) {
  const FieldValues field = fieldValues(fluid, options.field, options.state);
  check(fluid, field, options);
  const Range range = colorRange(field, options);
  const auto byValue = [&](std::size_t i) {
    return viridis((field.values[i] - range.low) / (range.high - range.low));
  };
  const std::vector<Particle> fluidParticles = drawable(fluid, options.spacing, byValue);
  const auto grey = [](std::size_t) { return Rgb{0.80, 0.80, 0.82}; };
  const std::vector<Particle> wallParticles = drawable(walls, options.spacing, grey);
  if (fluidParticles.empty() && wallParticles.empty())
    throw InputError("picture: the frame holds no particles that can be drawn");

  const bool solid = fluid.dimensions == 3;
  const Box box =
      boundsOf(fluidParticles, options.spacing / 2).joined(boundsOf(wallParticles, options.spacing / 2));
  View view = solid ? obliqueView(options.gravity) : View{};
  const PictureExtent extent = extentOf(box, view);
  const Theme theme{options.width / 1200.0};
  const Layout layout = layoutFor(extent, options.width, solid, theme);
  view.scale = layout.plotWidth / (extent.right - extent.left);
  view.origin = {layout.left - view.scale * extent.left, layout.top + view.scale * extent.top};

  Canvas canvas(options.width, layout.height);
  if (solid) {
    const Upward vertical = upward(options.gravity);
    drawBoxBehind(canvas, view, box, vertical, theme);
    drawOpened(canvas, view, wallParticles, options.spacing);
    drawSolid(canvas, view, fluidParticles, options.spacing);
    drawBoxInFront(canvas, view, box, theme);
  } else {
    drawFlat(canvas, view, wallParticles, options.spacing);
    drawFlat(canvas, view, fluidParticles, options.spacing);
    drawPlaneAxes(canvas, view, box, theme);
  }
  drawColorBar(canvas, layout, range, field, theme);
  drawHeading(canvas, options.title, fmt::format("t = {:.4g} s", fluid.time), theme);
  canvas.writePng(path);
  return fluid.position.size() + walls.position.size() - fluidParticles.size() - wallParticles.size();
}

}  // namespace treacle
