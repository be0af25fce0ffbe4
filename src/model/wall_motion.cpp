#include "treacle/model/wall_motion.hpp"

#include <algorithm>
#include <numbers>

namespace treacle {
namespace {

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

double angularFrequency(const Oscillation& o) { return 2 * std::numbers::pi / o.period; }

}  // namespace

Vec<3> wallDisplacement(const Body& body, double t) {
  const Oscillation& o = body.oscillation;
  if (o.period == 0) return t * body.velocity;
  return t * body.velocity + (std::sin(angularFrequency(o) * t + o.phase) - std::sin(o.phase)) * o.amplitude;
}

bool someWallOscillates(const Case& c) {
  return std::ranges::any_of(c.bodies, [](const Body& b) { return b.oscillation.period > 0; });
}
bool someWallRotates(const Case& c) {
  return std::ranges::any_of(c.bodies, [](const Body& b) { return b.rotation.has_value(); });
}

/// Products in place of differences: no digits are lost in short steps.
Vec<3> wallVelocity(const Body& body, double t, double dt) {
  const Oscillation& o = body.oscillation;
  if (o.period == 0) return body.velocity;
  const double omega = angularFrequency(o);
  const double rate = omega * std::cos(omega * (t + dt / 2) + o.phase) * sinc(omega * dt / 2);
  return body.velocity + rate * o.amplitude;
}

Vec<3> wallCenter(const Body& body, double t) {
  return body.rotation ? body.rotation->center + wallDisplacement(body, t) : Vec<3>{};
}

Vec<3> wallAcceleration(const Body& body, double t) {
  const Oscillation& o = body.oscillation;
  if (o.period == 0) return {};
  const double omega = angularFrequency(o);
  return (-omega * omega * std::sin(omega * t + o.phase)) * o.amplitude;
}

template <int D>
WallMotion<D> wallMotion(const Domain& domain, const Body& body, double t, double dt) {
  WallMotion<D> m;
  m.velocity = resized<D>(wallVelocity(body, t, dt));
  m.acceleration = resized<D>(wallAcceleration(body, t + dt));
  if (!body.rotation) return m;
  m.center = resized<D>(wallCenter(body, t));
  for (int k = 0; k < D; ++k)
    if (domain.periodic[static_cast<std::size_t>(k)]) m.period[k] = domain.max[k] - domain.min[k];
  const double speed = body.rotation->speed, half = sinc(speed * dt / 2);
  m.axis = body.rotation->direction();
  m.spin = speed * m.axis;
  m.sine = std::sin(speed * t);
  m.cosine = std::cos(speed * t);
  m.along = sinc(speed * dt);
  m.inwards = dt / 2 * half * half;
  return m;
}

template WallMotion<2> wallMotion<2>(const Domain&, const Body&, double, double);
template WallMotion<3> wallMotion<3>(const Domain&, const Body&, double, double);

}  // namespace treacle
