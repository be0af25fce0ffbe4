#include "lane_sums.hpp"
#include "treacle/mph/particle_sums.hpp"

namespace treacle {

TREACLE_PARTICLE_SUMS(2, Cpu)
TREACLE_PARTICLE_SUMS(3, Cpu)
template void setViscosities(Context<Cpu>&, const ViscosityTerms&);
template double countUnsound(Context<Cpu>&, std::span<const double>);
template double setVolumes(Context<Cpu>&, const VolumeTerms&);
template void setClasses(Context<Cpu>&, const ClassTerms&);
template double nextRates(Context<Cpu>&, const RateTerms&);

}  // namespace treacle
