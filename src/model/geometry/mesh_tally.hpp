#pragma once

#include "treacle/model/geometry/mesh.hpp"

#include <vector>

namespace treacle {

/// Makes one vertex of those that are within a millionth of the mesh's size along each axis: files of triangles
/// alone have each of them several times, and some programs round them differently.
void weld(Triangles& triangles);

/// Triangles that an earlier one is the same as, whichever corner they begin with, by their indices; in order.
std::vector<std::uint32_t> repeated(const Triangles& triangles);

/// Counts open and turned edges.
void tallyEdges(const Triangles& triangles, MeshFacts& facts);

}  // namespace treacle
