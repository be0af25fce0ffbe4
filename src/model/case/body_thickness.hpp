#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <utility>

namespace treacle {

/// Thinnest extent of a box or a round shape before its transform, with the words that say where.
std::pair<double, std::string> ownThickness(const Shape& s, int dimensions);

/// The shortest side of a fluid body that is a box, and otherwise how thick it is where it is thickest: the gap of
/// a ring, the wall of a shell [m]. A body that goes on across periodic ends has no side there, but for one that
/// does so along all axes.
double fluidThickness(const Case& c, const Body& body);

}  // namespace treacle
