#include "treacle/model/motion/wall_motion.hpp"

#include "geometry/wall_turn.hpp"
#include "treacle/core/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace treacle {
namespace {

/// A function of time as seen in a step, as what it changes by over the step's length; where that is zero over a
/// millionth of a second about t, which is what a derivative is then taken for.
struct Interval {
  double from, to, length;

  Interval(double t, double dt) : from(snapped(t)), to(snapped(t + dt)), length(dt) {
    if (dt == 0) from = t - 0.5e-6, to = t + 0.5e-6, length = 1e-6;
  }
  double rate(const TimeFunction& f) const { return (f.at(to) - f.at(from)) / length; }

  /// The end of a step must be the start of the next one, whatever rounding made of both: a function that jumps
  /// there would else jump twice, or never.
  static double snapped(double t) {
    constexpr double bits = 1LL << 48;
    int exponent = 0;
    const double mantissa = std::frexp(t, &exponent);
    return std::ldexp(std::round(mantissa * bits) / bits, exponent);
  }
};

Vec<3> rateOf(const TimeVector& f, double t, double dt) {
  Vec<3> rate{};
  for (std::size_t k = 0; k < 3; ++k)
    if (f[k] && (!f[k]->isConstant())) rate[static_cast<int>(k)] = Interval(t, dt).rate(*f[k]);
  return rate;
}

/// The second derivative, by differences. It means nothing at the corners of tables.
Vec<3> accelerationOf(const TimeVector& f, double t) {
  constexpr double e = 1e-4;
  Vec<3> a{};
  for (std::size_t k = 0; k < 3; ++k)
    if (f[k] && !f[k]->expression.empty())
      a[static_cast<int>(k)] = (f[k]->at(t + e) - 2 * f[k]->at(t) + f[k]->at(t - e)) / (e * e);
  return a;
}

double angleAt(const Rotation& r, double t) { return r.angle ? r.angle->at(t) - r.angle->at(0) : r.speed * t; }
double spinOver(const Rotation& r, double t, double dt) {
  return r.angle ? Interval(t, dt).rate(*r.angle) : r.speed;
}

double angularFrequency(const Oscillation& o) { return 2 * std::numbers::pi / o.period; }

}  // namespace

bool isDriven(const TimeVector& f) {
  return std::ranges::any_of(f, [](const auto& component) { return component && !component->isConstant(); });
}

Vec<3> wallDisplacement(const Body& body, double t) {
  const Oscillation& o = body.oscillation;
  Vec<3> way = t * body.velocity;
  if (o.period != 0) way = way + (std::sin(angularFrequency(o) * t + o.phase) - std::sin(o.phase)) * o.amplitude;
  for (std::size_t k = 0; k < 3; ++k)
    if (const auto& f = body.displacement[k]) way[static_cast<int>(k)] += f->at(t) - f->at(0);
  return way;
}

bool someWallIsDriven(const Case& c) {
  return std::ranges::any_of(c.bodies,
                             [](const Body& b) { return b.oscillation.period > 0 || isDriven(b.displacement); });
}
bool someWallRotates(const Case& c) {
  return std::ranges::any_of(c.bodies, [](const Body& b) { return b.rotation.has_value(); });
}

/// Products in place of differences: no digits are lost in short steps.
Vec<3> wallVelocity(const Body& body, double t, double dt) {
  const Oscillation& o = body.oscillation;
  const Vec<3> given = body.velocity + rateOf(body.displacement, t, dt);
  if (o.period == 0) return given;
  const double omega = angularFrequency(o);
  const double rate = omega * std::cos(omega * (t + dt / 2) + o.phase) * sinc(omega * dt / 2);
  return given + rate * o.amplitude;
}

double wallSpin(const Body& body, double t, double dt) {
  return body.rotation ? spinOver(*body.rotation, t, dt) : 0;
}

Vec<3> wallCenter(const Body& body, double t) {
  return body.rotation ? body.rotation->center + wallDisplacement(body, t) : Vec<3>{};
}

Vec<3> wallAcceleration(const Body& body, double t) {
  const Oscillation& o = body.oscillation;
  const Vec<3> given = accelerationOf(body.displacement, t);
  if (o.period == 0) return given;
  const double omega = angularFrequency(o);
  return given + (-omega * omega * std::sin(omega * t + o.phase)) * o.amplitude;
}

template <int D>
WallMotion<D> wallTurn(const Body& body, double t) {
  WallMotion<D> m;
  if (!body.rotation) return m;
  const double turned = angleAt(*body.rotation, t);
  m.axis = body.rotation->direction();
  m.sine = std::sin(turned);
  m.cosine = std::cos(turned);
  return m;
}

template <int D>
WallMotion<D> wallMotion(const Domain& domain, const Body& body, double t, double dt) {
  WallMotion<D> m = wallTurn<D>(body, t);
  m.velocity = resized<D>(wallVelocity(body, t, dt));
  m.acceleration = resized<D>(wallAcceleration(body, t + dt));
  if (!body.rotation) return m;
  m.center = resized<D>(wallCenter(body, t));
  for (int k = 0; k < D; ++k)
    if (domain.periodic[static_cast<std::size_t>(k)]) m.period[k] = domain.max[k] - domain.min[k];
  const double speed = spinOver(*body.rotation, t, dt), half = sinc(speed * dt / 2);
  m.spin = speed * m.axis;
  m.along = sinc(speed * dt);
  m.inwards = dt / 2 * half * half;
  return m;
}

template WallMotion<2> wallTurn<2>(const Body&, double);
template WallMotion<3> wallTurn<3>(const Body&, double);
template WallMotion<2> wallMotion<2>(const Domain&, const Body&, double, double);
template WallMotion<3> wallMotion<3>(const Domain&, const Body&, double, double);

}  // namespace treacle
