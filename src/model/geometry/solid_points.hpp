#pragma once

#include "solid.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/case.hpp"

#include <functional>
#include <string>
#include <vector>

namespace treacle {

/// For the caller to throw where a body would have more than maxParticles.
InputError tooManyPoints(const Body& body);

/// The points of a polygon or mesh, x fastest, on a lattice that all of them share, whose first point is half a
/// spacing inside the domain's corner `min`: fluid inside and wall outside of one surface part it. A note says
/// where there are none. Errors: InputError for a body that is not in the domain, or far larger, which is mostly
/// one of another unit; for more than maxParticles points; what `keep` throws.
template <int D>
std::vector<Vec<D>> solidPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                const std::function<bool(const Vec<D>&)>& keep);

/// The places of that lattice on both sides of a thin sheet that its particles take, as far as particles act on
/// each other and inside the domain. `keep`: asked of the nearest point of the sheet.
template <int D>
std::vector<Vec<D>> sheetPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                const std::function<bool(const Vec<D>&)>& keep);

}  // namespace treacle
