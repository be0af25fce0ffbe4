#include "mph/step_sums.cuh"
#include "treacle/mph/repulsion_sums.hpp"

namespace treacle {

TREACLE_REPULSION_SUMS(2, Cuda)
TREACLE_REPULSION_SUMS(3, Cuda)

}  // namespace treacle
