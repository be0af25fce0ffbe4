#pragma once

#include "treacle/model/case/case.hpp"

#include <algorithm>

namespace treacle {

/// Whether a case with heat exchanges some through its free surfaces.
inline bool hasSurfaceHeat(const Case& c) {
  return c.heat->transfer > 0 ||
         std::ranges::any_of(c.materials, [](const Material& m) { return m.emissivity > 0; });
}

}  // namespace treacle
