// In place of volume_mesh_load.cpp where there is no OpenVDB.
#include "treacle/core/error.hpp"
#include "volume_mesh.hpp"

namespace treacle {

std::string whyNoVolumeMesh() {
  return "this build makes no surfaces: OpenVDB was not found when it was configured (Debian: libopenvdb-dev and "
         "libboost-dev, which scripts/setup installs; then configure and build again)";
}

TriangleMesh volumeMesh(const BlockedField&) { throw InputError(whyNoVolumeMesh()); }

}  // namespace treacle
