#include "treacle/model/motion/carried_probe.hpp"

#include "geometry/wall_turn.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace treacle {

Probe carriedProbe(const Probe& probe, const Case& c, std::span<const RigidBody> rigid, double t) {
  const std::string& name = probe.kind == ProbeKind::WallPressure ? probe.body : probe.movesWith;
  const auto carrier = std::ranges::find(c.bodies, name, &Body::name);
  if (carrier == c.bodies.end()) return probe;
  const Body& body = *carrier;
  Probe moved = probe;
  const auto move = [&](const auto& turned, const Vec<3>& from, const Vec<3>& to) {
    for (Vec<3>* place : {&moved.point, &moved.from, &moved.to, &moved.corner})
      *place = to + turned(*place - from);
    for (Vec<3>* direction : {&moved.along, &moved.up, &moved.normal}) *direction = turned(*direction);
  };
  if (body.kind == BodyKind::Rigid) {
    const RigidBody& now = rigid[static_cast<std::size_t>(carrier - c.bodies.begin())];
    move([&](const Vec<3>& v) { return turnedBy(now.orientation, v); }, {}, now.center);
  } else {
    const Vec<3> center = body.rotation ? body.rotation->center : Vec<3>{};
    const WallMotion<3> turn = wallTurn<3>(body, t);
    move([&](const Vec<3>& v) { return turn.turned(v); }, center, center + wallDisplacement(body, t));
  }
  return moved;
}

}  // namespace treacle
