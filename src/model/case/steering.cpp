#include "treacle/model/case/steering.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace treacle {
namespace {

constexpr double endless = 1e6;  // for which a velocity holds, unless it is changed [s]

/// The corners that a function has before time t, and its value there. `rate`: what is added to it in a second.
TimeFunction past(const std::optional<TimeFunction>& f, double rate, double t) {
  TimeFunction before;
  const auto add = [&](double time) {
    before.times.push_back(time);
    before.values.push_back((f ? f->at(time) : 0) + rate * time);
  };
  if (t > 0) add(0);
  if (f)
    for (const double time : f->times)
      if (time > 0 && time < t) add(time);
  add(t);
  return before;
}

/// From time t on a straight line.
TimeFunction goingOn(const std::optional<TimeFunction>& f, double rateBefore, double t, double rate) {
  TimeFunction next = past(f, rateBefore, t);
  next.values.push_back(next.values.back() + rate * endless);
  next.times.push_back(t + endless);
  return next;
}

/// From time t on a constant.
TimeFunction switchedTo(const TimeFunction& f, double t, double value) {
  if (t == 0) return {.value = value};
  TimeFunction next = past(f, 0, t);
  next.times.push_back(std::nextafter(t, std::numeric_limits<double>::infinity()));
  next.values.push_back(value);
  return next;
}

/// A body whose motion is being changed at a time.
class MovedBody {
 public:
  MovedBody(const Body& body, double t) : body_(body), t_(t) {}

  void steer(const Vec<3>& velocity) {
    if (body_.kind != BodyKind::Inflow && body_.kind != BodyKind::Wall)
      fail("velocity", "it is neither a wall nor an inflow");
    if (body_.oscillation.period > 0) fail("velocity", "it oscillates");
    for (std::size_t k = 0; k < 3; ++k) {
      auto& way = body_.displacement[k];
      const double before = body_.velocity[static_cast<int>(k)], rate = velocity[static_cast<int>(k)];
      if (way) requireNoFormula(*way, "velocity", "displacement");
      if (way || before != 0 || rate != 0) way = goingOn(way, before, t_, requireFinite(rate, "velocity"));
    }
    body_.velocity = {};
  }

  void turn(double spin) {
    if (!body_.rotation) fail("angular_velocity", "it has no rotation, which would say about what it turns");
    Rotation& r = *body_.rotation;
    if (r.angle) requireNoFormula(*r.angle, "angular_velocity", "rotation.angle");
    r.angle = goingOn(r.angle, r.angle ? 0 : r.speed, t_, requireFinite(spin, "angular_velocity"));
    r.speed = 0;
  }

  void flow(double value, std::optional<TimeFunction> Inflow::*which, const char* what, const char* other) {
    if (body_.kind != BodyKind::Inflow) fail(what, "it is not an inflow");
    std::optional<TimeFunction>& f = body_.inflow.*which;
    if (!f) fail(what, fmt::format("the case gives its {}", other));
    requireNoFormula(*f, what, what);
    if (requireFinite(value, what) < 0)
      fail(what, fmt::format("expected a number of at least 0, found {:g}", value));
    f = switchedTo(*f, t_, value);
  }

  const Body& body() const { return body_; }

 private:
  [[noreturn]] void fail(const char* what, const std::string& why) const {
    throw InputError(fmt::format("{} of '{}': {}", what, body_.name, why));
  }
  void requireNoFormula(const TimeFunction& f, const char* what, const char* key) const {
    if (!f.expression.empty())
      fail(what, fmt::format("{} is a formula, \"{}\"; expected a number or a table", key, f.expression));
  }
  double requireFinite(double value, const char* what) const {
    if (!std::isfinite(value)) fail(what, fmt::format("expected finite numbers, found {:g}", value));
    return value;
  }

  Body body_;
  double t_;
};

}  // namespace

Body steered(const Body& body, const Steering& steering, double t) {
  MovedBody moved(body, t);
  if (steering.velocity) moved.steer(*steering.velocity);
  if (steering.spin) moved.turn(*steering.spin);
  if (steering.speed) moved.flow(*steering.speed, &Inflow::speed, "speed", "flow_rate");
  if (steering.flowRate) moved.flow(*steering.flowRate, &Inflow::flowRate, "flow_rate", "speed");
  return moved.body();
}

bool isSteeredAlready(const Body& body, const Body& next) {
  const auto turns = [](const Body& b) { return b.rotation && b.rotation->angle; };
  return isDriven(body.displacement) == isDriven(next.displacement) && turns(body) == turns(next) &&
         body.velocity == next.velocity;
}

}  // namespace treacle
