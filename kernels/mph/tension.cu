#include "mph/step_sums.cuh"
#include "treacle/mph/tension_sums.hpp"

namespace treacle {

TREACLE_TENSION_SUMS(2, Cuda)
TREACLE_TENSION_SUMS(3, Cuda)
template void letWallsYield(Context<Cuda>&, std::span<double>);
template void shareTension(Context<Cuda>&, std::span<const double>, std::span<double>);

}  // namespace treacle
