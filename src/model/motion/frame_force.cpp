#include "treacle/model/motion/frame_force.hpp"

#include "treacle/model/motion/wall_motion.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {

/// The frame turns as a wall with the same rotation would.
template <int D>
FrameForce<D> FrameForce<D>::of(const Case& c, double from, double to) {
  FrameForce f;
  if (!c.frame) {
    f.gravity = resized<D>(c.gravity);
    return f;
  }
  Body wall;
  wall.rotation = c.frame;
  // Functions of time begin with the case.
  const double start = std::max(from, 0.0), length = std::max(to - start, 0.0), middle = start + 0.5 * length;
  f.turns = true;
  f.center = resized<D>(c.frame->center);
  f.axis = c.frame->direction();
  const double omega = wallSpin(wall, start, length);
  f.spin = omega * f.axis;
  constexpr double e = 1e-4;
  if (c.frame->angle)
    f.spinChange = ((wallSpin(wall, middle + e) - wallSpin(wall, middle - e)) / (2 * e)) * f.axis;
  f.sine = std::sin(2 * omega * (to - from)), f.cosine = std::cos(2 * omega * (to - from));
  // What stands still outside turns backwards in the frame.
  WallMotion<3> turn = wallMotion<3>(c.domain, wall, middle, 0);
  turn.sine = -turn.sine;
  f.gravity = resized<D>(turn.turned(c.gravity));
  return f;
}

template struct FrameForce<2>;
template struct FrameForce<3>;

}  // namespace treacle
