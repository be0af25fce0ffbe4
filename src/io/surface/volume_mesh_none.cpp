// In place of volume_mesh.cpp where there is no OpenVDB.
#include "treacle/core/error.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "volume_mesh.hpp"

namespace treacle {

bool hasVolumeMesh() { return false; }

TriangleMesh volumeMesh(const BlockedField&) { throw InputError(whyNoFreeSurface()); }

}  // namespace treacle
