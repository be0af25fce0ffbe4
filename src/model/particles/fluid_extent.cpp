#include "fluid_extent.hpp"

#include "body_points.hpp"
#include "treacle/model/case/expression.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace treacle {
namespace {

/// The rate of a function of time, which is asked many times: its expression is read once.
class Rate {
 public:
  explicit Rate(const std::optional<TimeFunction>& f) : function_(f && !f->isConstant() ? &*f : nullptr) {
    if (function_ && !function_->expression.empty())
      expression_.emplace(Expression::ofTime(function_->expression));
  }
  bool isDriven() const { return function_ != nullptr; }
  double at(double t) const {
    constexpr double half = 0.5e-6;  // [s]
    return function_ ? (value(t + half) - value(t - half)) / (2 * half) : 0;
  }
  /// Appends the middles between the rows of its table, as far as they are before the end.
  void addTimes(double end, std::vector<double>& times) const {
    for (std::size_t k = 1; function_ && k < function_->times.size(); ++k)
      if (const double t = (function_->times[k - 1] + function_->times[k]) / 2; t > 0 && t < end)
        times.push_back(t);
  }

 private:
  double value(double t) const { return expression_ ? (*expression_)({t, 0, 0}) : function_->at(t); }

  const TimeFunction* function_;
  std::optional<Expression> expression_;
};

/// When a wall or nozzle moves fastest, and when it turns fastest: among many times of the run, and those between
/// the rows of its tables.
struct Fastest {
  double translation = 0;  // speed of the wall, or of its centre, without its oscillation [m/s]
  double turning = 0;      // time [s]
};

Fastest fastestOf(const Body& body, double end) {
  constexpr int samples = 1000;
  const std::array<Rate, 3> way{Rate(body.displacement[0]), Rate(body.displacement[1]),
                                Rate(body.displacement[2])};
  static const std::optional<TimeFunction> none;
  const Rate angle(body.rotation ? body.rotation->angle : none);
  std::vector<double> times{0};
  for (const Rate* rate : {&way[0], &way[1], &way[2], &angle}) rate->addTimes(end, times);
  if (angle.isDriven() || std::ranges::any_of(way, &Rate::isDriven))
    for (int k = 0; k < samples; ++k) times.push_back((k + 0.5) / samples * end);
  Fastest fastest;
  double spin = 0;
  for (const double t : times) {
    const Vec<3> velocity = body.velocity + Vec<3>{way[0].at(t), way[1].at(t), way[2].at(t)};
    if (const double speed = norm(velocity); std::isfinite(speed))
      fastest.translation = std::max(fastest.translation, speed);
    if (const double now = std::abs(angle.at(t)); now > spin) spin = now, fastest.turning = t;
  }
  return fastest;
}

/// Largest speed of a fluid body at the start, of a wall at any time [m/s].
template <int D>
double largestSpeed(const Case& c, const Body& body) {
  const Oscillation& o = body.oscillation;
  const Fastest fastest = fastestOf(body, c.time.end);
  const double swing = o.period > 0 ? 2 * std::numbers::pi * norm(o.amplitude) / o.period : 0;
  const double carried = fastest.translation + swing;
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

}  // namespace

Heights heightsOf(const Case& c, const Extent& box) {
  Heights h;
  for (int k = 0; k < 8; ++k) {
    const Vec<3> corner{k & 1 ? box.max[0] : box.min[0], k & 2 ? box.max[1] : box.min[1],
                        k & 4 ? box.max[2] : box.min[2]};
    const double up = -dot(corner, c.gravity) / norm(c.gravity);
    h.low = std::min(h.low, up), h.high = std::max(h.high, up);
  }
  return h;
}

double fluidHeight(const Case& c) {
  if (norm(c.gravity) == 0) return 0;
  Heights all;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Heights h = heightsOf(c, boundingBox(body.shape, c.dimensions));
    all.low = std::min(all.low, h.low), all.high = std::max(all.high, h.high);
  }
  return all.extent();
}

double givenSpeed(const Case& c) {
  double speed = 0;
  for (const Body& body : c.bodies)
    speed = std::max(speed, c.dimensions == 2 ? largestSpeed<2>(c, body) : largestSpeed<3>(c, body));
  return speed;
}

}  // namespace treacle
