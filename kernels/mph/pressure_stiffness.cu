#include "mph/step_sums.cuh"
#include "treacle/mph/stiffness_sums.hpp"

namespace treacle {

TREACLE_STIFFNESS_SUMS(2, Cuda)
TREACLE_STIFFNESS_SUMS(3, Cuda)
TREACLE_STIFFNESS(Cuda)

}  // namespace treacle
