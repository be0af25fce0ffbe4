#include "fluid_extent.hpp"

#include "body_points.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace treacle {
namespace {

constexpr int samples = 1000;  // of a run

/// When a wall or nozzle moves fastest, and when it turns fastest: among many times of the run, and those between
/// the rows of its tables.
struct Fastest {
  double translation = 0;  // speed of the wall, or of its centre [m/s]
  double turning = 0;      // time [s]
};

/// The largest mean speed over a step of a wall or nozzle that formulas move: one that jumps moves by a finite way
/// in a step [m/s].
double fastestStep(const Body& body, const TimeSettings& time) {
  const int parts = static_cast<int>(std::clamp(std::ceil(time.end / time.step), 1.0, double{samples}));
  double fastest = 0;
  for (int k = 0; k < parts; ++k) {
    double length = time.end / parts, from = k * length;
    while (length > time.step) {
      length /= 2;
      const auto way = [&](double start) { return norm(wallVelocity(body, start, length)); };
      if (way(from + length) > way(from)) from += length;
    }
    fastest = std::max(fastest, norm(wallVelocity(body, from, length)) * length / time.step);
  }
  return fastest;
}

Fastest fastestOf(const Body& body, const TimeSettings& time) {
  const double end = time.end;
  std::vector<double> times{0};
  const auto addTable = [&](const std::optional<TimeFunction>& f) {
    for (std::size_t k = 1; f && k < f->times.size(); ++k)
      if (const double t = (f->times[k - 1] + f->times[k]) / 2; t > 0 && t < end) times.push_back(t);
  };
  for (const auto& component : body.displacement) addTable(component);
  if (body.rotation) addTable(body.rotation->angle);
  if (isDriven(body.displacement) || (body.rotation && body.rotation->angle))
    for (int k = 0; k < samples; ++k) times.push_back((k + 0.5) / samples * end);
  Fastest fastest;
  double spin = 0;
  for (const double t : times) {
    fastest.translation = std::max(fastest.translation, norm(wallVelocity(body, t, 0)));
    if (const double now = std::abs(wallSpin(body, t)); now > spin) spin = now, fastest.turning = t;
  }
  const bool formula =
      std::ranges::any_of(body.displacement, [](const auto& f) { return f && !f->expression.empty(); });
  constexpr double jump = 2;  // times what no time but that of a jump has
  if (formula && !time.automatic)
    if (const double speed = fastestStep(body, time); speed > jump * fastest.translation)
      fastest.translation = speed;
  return fastest;
}

/// Largest speed of a fluid body at the start, of a wall at any time [m/s].
template <int D>
double largestSpeed(const Case& c, const Body& body) {
  const Oscillation& o = body.oscillation;
  const Fastest fastest = fastestOf(body, c.time);
  const double swing = o.period > 0 ? 2 * std::numbers::pi * norm(o.amplitude) / o.period : 0;
  const double carried = std::max(norm(body.velocity) + swing, fastest.translation);
  const bool expressions = body.velocityExpression != decltype(body.velocityExpression){};
  if (!expressions && !body.fileVelocities && !body.rotation) return carried;
  const InitialState<D> initial(c, body);
  const WallMotion<D> wall = wallMotion<D>(c.domain, body, fastest.turning, 0);
  const Vec<D> center = resized<D>(body.rotation ? body.rotation->center : Vec<3>{});
  std::vector<std::string> notes;
  double speed = 0;
  const BodyPoints<D> points = body.kind == BodyKind::Inflow ? nozzlePoints<D>(c, body, BodyKind::Wall, notes)
                                                             : bodyPoints<D>(c, body, notes);
  for (std::size_t k = 0; k < points.size(); ++k)
    speed = std::max(speed,
                     norm(body.rotation ? wall.swirl(points.place[k] - center) : initial.velocityAt(points, k)));
  return body.rotation ? carried + speed : speed;
}

template <int D>
CentrifugalScale centrifugalScaleOf(const Case& c) {
  FrameForce<D> fastest = FrameForce<D>::of(c, 0, 0);
  for (int k = 1; k <= samples; ++k) {
    const double t = c.time.end * k / samples;
    if (const auto frame = FrameForce<D>::of(c, t, t); norm(frame.spin) > norm(fastest.spin)) fastest = frame;
  }
  fastest.gravity = {};
  double low = std::numeric_limits<double>::infinity(), high = 0;  // of minus the potential
  std::vector<std::string> notes;
  for (const Body& body : c.bodies)
    if (body.kind == BodyKind::Fluid)
      for (const Vec<D>& x : bodyPoints<D>(c, body, notes).place) {
        const double minus = -fastest.potential(x);
        low = std::min(low, minus), high = std::max(high, minus);
      }
  return {norm(fastest.spin) * std::sqrt(2 * high), std::max(0.0, high - low)};
}

/// `placed`: where a corner of the box is.
Heights heightsOfCorners(const Case& c, const Extent& box, auto&& placed) {
  Heights h;
  for (int k = 0; k < 8; ++k) {
    const Vec<3> corner{k & 1 ? box.max[0] : box.min[0], k & 2 ? box.max[1] : box.min[1],
                        k & 4 ? box.max[2] : box.min[2]};
    const double up = -dot(placed(corner), c.gravity) / norm(c.gravity);
    h.low = std::min(h.low, up), h.high = std::max(h.high, up);
  }
  return h;
}

}  // namespace

CentrifugalScale centrifugalScale(const Case& c) {
  if (!c.frame) return {};
  return c.dimensions == 2 ? centrifugalScaleOf<2>(c) : centrifugalScaleOf<3>(c);
}

Heights heightsOf(const Case& c, const Extent& box) {
  return heightsOfCorners(c, box, [](const Vec<3>& x) { return x; });
}

Heights heightsOf(const Case& c, const Shape& shape) {
  const Extent box = untransformedBox(shape, c.dimensions);
  return heightsOfCorners(c, box, [&](const Vec<3>& x) {
    return c.dimensions == 2 ? resized<3>(similarityOf<2>(shape).point(resized<2>(x)))
                             : similarityOf<3>(shape).point(x);
  });
}

double fluidHeight(const Case& c) {
  if (norm(c.gravity) == 0) return 0;
  Heights all;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Heights h = heightsOf(c, body.shape);
    all.low = std::min(all.low, h.low), all.high = std::max(all.high, h.high);
  }
  return all.extent();
}

double largestSpeedOf(const Case& c, const Body& body) {
  return c.dimensions == 2 ? largestSpeed<2>(c, body) : largestSpeed<3>(c, body);
}

double givenSpeed(const Case& c) {
  double speed = 0;
  for (const Body& body : c.bodies) speed = std::max(speed, largestSpeedOf(c, body));
  return speed;
}

}  // namespace treacle
