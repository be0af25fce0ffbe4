#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle {

enum class Coordinate { X, Y, Z };

/// A stretch of one axis that is to become wider or narrower.
struct Width {
  Coordinate axis = Coordinate::X;
  double from = 0, to = 0;  // [m]
  double factor = 1;

  bool operator==(const Width&) const = default;
};

/// Scales the coordinates of domain, bodies and centres of rotation that lie in the stretch, and moves those
/// beyond `to` along with it. Radii and expressions stay what they are. Errors: CaseError at "width" for one that
/// is none.
void applyWidth(Case& c, const Width& width);

}  // namespace treacle
