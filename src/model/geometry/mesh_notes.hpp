#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

/// Errors: InputError for a shape of a file that was not read, and for a mesh that cannot be filled: one without a
/// face that has an area, or inside-out.
void requireContent(const Body& body);

/// Appends what a user should know of the mesh of a body: where it is open, whose faces do not agree on where
/// outside is, faces that are left out, and faces that cut each other; nothing where an earlier body has the same
/// mesh.
void noteMesh(const Case& c, const Body& body, std::vector<std::string>& notes);

}  // namespace treacle
