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

}  // namespace

RigidBody forcePlace(const RigidBody& before, const RigidBody& now, double dt) {
  RigidBody place = before;
  place.velocity = 0.25 * (now.velocity - before.velocity), place.spin = 0.25 * (now.spin - before.spin);
  place.advance(dt);
  return place;
}

GivenForces givenForces(const RigidSettings& settings, const RigidBody& before, const RigidBody& now,
                        const ForceInterval& interval) {
  const double from = std::max(interval.from, 0.0);  // functions of time begin with the case
  const Vec<3> velocity = 0.5 * (before.velocity + now.velocity), spin = 0.5 * (before.spin + now.spin);
  GivenForces sum{meanOf(settings.force, from, interval.to) - settings.damping * velocity,
                  meanOf(settings.torque, from, interval.to) - settings.angularDamping * spin};
  if (settings.springs.empty()) return sum;
  const RigidBody at = forcePlace(before, now, interval.dt);
  for (const Spring& s : settings.springs) {
    const Vec<3> arm = turnedBy(at.orientation, s.arm), way = at.center + arm - s.anchor;
    const double length = norm(way);
    if (length == 0) continue;
    const Vec<3> along = (1 / length) * way;
    const double rate = dot(velocity + cross(spin, arm), along);
    const Vec<3> force = -(s.stiffness * (length - s.length) + s.damping * rate) * along;
    sum.force += force, sum.torque += cross(arm, force);
  }
  return sum;
}

}  // namespace treacle
