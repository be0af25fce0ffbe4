#include "lane_sums.hpp"
#include "treacle/mph/tension_sums.hpp"

namespace treacle {

TREACLE_TENSION_SUMS(2, Cpu)
TREACLE_TENSION_SUMS(3, Cpu)
template void letWallsYield(Context<Cpu>&, std::span<double>);
template void shareTension(Context<Cpu>&, std::span<const double>, std::span<double>);

}  // namespace treacle
