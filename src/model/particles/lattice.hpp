#pragma once

#include "treacle/model/case/case.hpp"

#include <functional>
#include <string>
#include <vector>

namespace treacle {

/// The lattice points of one body, x fastest, whose lattice turns with its transform: a box gets a whole number of
/// points per axis, at least one, starting half a spacing inside its corner `min`. Where its extent is not that
/// number of spacings, a wall's points start at the face that is nearer to the fluid, and a note says so. Polygons
/// and meshes have the points of a lattice that all of them share (solidPoints). `keep`: called with each point in
/// their order; where it is false the point is left out. Errors: InputError for more than maxParticles points;
/// what `keep` throws.
template <int D>
std::vector<Vec<D>> latticePoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                  const std::function<bool(const Vec<D>&)>& keep);

}  // namespace treacle
