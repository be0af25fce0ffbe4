#include "mph/step_sums.cuh"
#include "treacle/mph/surface_sums.hpp"

namespace treacle {

TREACLE_SURFACE_SUMS(2, Cuda)
TREACLE_SURFACE_SUMS(3, Cuda)

}  // namespace treacle
