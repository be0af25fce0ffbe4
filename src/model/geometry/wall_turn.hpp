#pragma once

#include "treacle/model/motion/wall_motion.hpp"

namespace treacle {

/// How far a wall or nozzle is turned at time t: a motion of which only that, for turned(), is set.
template <int D>
WallMotion<D> wallTurn(const Body& body, double t);

extern template WallMotion<2> wallTurn<2>(const Body&, double);
extern template WallMotion<3> wallTurn<3>(const Body&, double);

}  // namespace treacle
