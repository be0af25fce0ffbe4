#include "mph/step_sums.cuh"
#include "treacle/mph/particle_sums.hpp"

namespace treacle {

TREACLE_PARTICLE_SUMS(2, Cuda)
TREACLE_PARTICLE_SUMS(3, Cuda)
template void setViscosities(Context<Cuda>&, const ViscosityTerms&);
template double countUnsound(Context<Cuda>&, std::span<const double>);
template double setVolumes(Context<Cuda>&, const VolumeTerms&);
template void setClasses(Context<Cuda>&, const ClassTerms&);
template double nextRates(Context<Cuda>&, const RateTerms&);

}  // namespace treacle
