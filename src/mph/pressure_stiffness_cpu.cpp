#include "lane_sums.hpp"
#include "treacle/mph/stiffness_sums.hpp"

namespace treacle {

TREACLE_STIFFNESS_SUMS(2, Cpu)
TREACLE_STIFFNESS_SUMS(3, Cpu)
TREACLE_STIFFNESS(Cpu)

}  // namespace treacle
