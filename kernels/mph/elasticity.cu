#include "mph/step_sums.cuh"
#include "treacle/mph/elasticity_sums.hpp"

namespace treacle {

TREACLE_ELASTICITY_SUMS(2, Cuda)
TREACLE_ELASTICITY_SUMS(3, Cuda)

}  // namespace treacle
