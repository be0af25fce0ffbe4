#include "mph/step_sums.cuh"
#include "treacle/mph/energy_sums.hpp"

namespace treacle {

TREACLE_ENERGY_SUMS(2, Cuda)
TREACLE_ENERGY_SUMS(3, Cuda)

}  // namespace treacle
