#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/rigid_body.hpp"

#include <span>

namespace treacle {

/// The probe as the body that carries it, or whose patch it is, has moved it by time t [s]. Its places are those
/// that it has at t = 0 on a wall; on a rigid body they are ways from the centre of mass, turned with the body
/// since the start. `rigid`: per body of the case, may be empty where none is rigid.
Probe carriedProbe(const Probe& probe, const Case& c, std::span<const RigidBody> rigid, double t);

}  // namespace treacle
