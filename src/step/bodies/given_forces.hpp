#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/rigid_body.hpp"

#include <span>
#include <vector>

namespace treacle {

/// What the case does to a rigid body beside fluid, gravity and contacts.
struct GivenForces {
  Vec<3> force{};   // [N]
  Vec<3> torque{};  // about the centre of mass [N m]
};

/// From what time to what time on velocities change in a step of dt that positions make [s].
struct ForceInterval {
  double from, to, dt;
};

/// The body where forces that follow its place are taken: at its start, gone on by dt^2/4 of the acceleration, the
/// rule of Newmark with beta = 1/4, which neither takes nor gives energy, however stiff they are.
RigidBody forcePlace(const RigidBody& before, const RigidBody& now, double dt);

/// Forces of a step, per body of the case, in which the bodies go from the velocities of `before`, the state at
/// its start, to those of `now`: given ones as their mean over the time in which velocities change, springs at
/// forcePlace, dampers by the mean velocity. Bodies that are not rigid have none.
std::vector<GivenForces> givenForces(const Case& c, std::span<const RigidBody> before,
                                     std::span<const RigidBody> now, const ForceInterval& interval);

}  // namespace treacle
