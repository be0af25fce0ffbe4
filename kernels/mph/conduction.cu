#include "mph/step_sums.cuh"
#include "treacle/mph/conduction_sums.hpp"

namespace treacle {

TREACLE_CONDUCTION_SUMS(2, Cuda)
TREACLE_CONDUCTION_SUMS(3, Cuda)

}  // namespace treacle
