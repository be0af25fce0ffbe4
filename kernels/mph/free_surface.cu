#include "mph/step_sums.cuh"
#include "treacle/mph/free_surface_sums.hpp"

namespace treacle {

TREACLE_FREE_SURFACE_SUMS(2, Cuda)
TREACLE_FREE_SURFACE_SUMS(3, Cuda)

}  // namespace treacle
