#include "given_forces.hpp"

#include <algorithm>
#include <cstddef>

namespace treacle {
namespace {

Vec<3> meanOf(const TimeVector& f, double from, double to) {
  Vec<3> mean{};
  for (std::size_t k = 0; k < 3; ++k)
    if (f[k])
      mean[static_cast<int>(k)] = f[k]->isConstant() ? f[k]->value : f[k]->integral(from, to) / (to - from);
  return mean;
}

/// Where a spring ends, at forcePlace of a body, and how fast that goes, the mean over the step.
struct SpringEnd {
  Vec<3> place{}, velocity{};  // [m], [m/s]
  Vec<3> arm{};                // from the centre of mass [m]

  static SpringEnd on(const RigidBody& before, const RigidBody& now, const Vec<3>& arm, double dt) {
    const RigidBody at = forcePlace(before, now, dt);
    const Vec<3> turned = turnedBy(at.orientation, arm);
    return {at.center + turned,
            0.5 * (before.velocity + now.velocity) + cross(0.5 * (before.spin + now.spin), turned), turned};
  }
};

/// On the end of a spring, with its other end at `from`.
Vec<3> springForce(const Spring& s, const SpringEnd& from, const SpringEnd& end) {
  const Vec<3> way = end.place - from.place;
  const double length = norm(way);
  if (length == 0) return {};
  const Vec<3> along = (1 / length) * way;
  return -(s.stiffness * (length - s.length) + s.damping * dot(end.velocity - from.velocity, along)) * along;
}

}  // namespace

RigidBody forcePlace(const RigidBody& before, const RigidBody& now, double dt) {
  RigidBody place = before;
  place.velocity = 0.25 * (now.velocity - before.velocity), place.spin = 0.25 * (now.spin - before.spin);
  place.advance(dt);
  return place;
}

std::vector<GivenForces> givenForces(const Case& c, std::span<const RigidBody> before,
                                     std::span<const RigidBody> now, const ForceInterval& interval) {
  const double from = std::max(interval.from, 0.0);  // functions of time begin with the case
  std::vector<GivenForces> sums(c.bodies.size());
  const auto add = [&](std::size_t b, const SpringEnd& end, const Vec<3>& force) {
    sums[b].force += force, sums[b].torque += cross(end.arm, force);
  };
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    if (c.bodies[b].kind != BodyKind::Rigid) continue;
    const RigidSettings& settings = c.bodies[b].rigid;
    sums[b].force += meanOf(settings.force, from, interval.to) -
                     0.5 * settings.damping * (before[b].velocity + now[b].velocity);
    sums[b].torque += meanOf(settings.torque, from, interval.to) -
                      0.5 * settings.angularDamping * (before[b].spin + now[b].spin);
    for (const Spring& s : settings.springs) {
      const auto other = std::ranges::find(c.bodies, s.to, &Body::name);
      const auto k = static_cast<std::size_t>(other - c.bodies.begin());
      const SpringEnd end = SpringEnd::on(before[b], now[b], s.arm, interval.dt);
      const SpringEnd start =
          s.to.empty() ? SpringEnd{.place = s.anchor} : SpringEnd::on(before[k], now[k], s.anchor, interval.dt);
      const Vec<3> force = springForce(s, start, end);
      add(b, end, force);
      if (!s.to.empty()) add(k, start, -1.0 * force);
    }
  }
  return sums;
}

}  // namespace treacle
