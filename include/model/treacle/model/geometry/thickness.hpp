#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

namespace treacle {

/// Where a polygon or mesh is thin: a way from its surface straight inward is shorter than some limit.
struct ThinParts {
  double share = 0;      // of the surface
  double thickness = 0;  // median over these parts [m]
  Vec<3> place{};        // where they are as thick as that [m]
};
/// `limit` [m].
ThinParts thinParts(const Shape& shape, int dimensions, double limit);

/// Whether a body, a thin sheet, is given as a thin solid, and the sheet is in the middle of it.
/// Errors: InputError, those of the sheet.
bool isMiddleOfSolid(const Case& c, const Body& body);

}  // namespace treacle
