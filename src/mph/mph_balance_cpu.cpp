#include "lane_sums.hpp"
#include "treacle/mph/energy_sums.hpp"

namespace treacle {

TREACLE_ENERGY_SUMS(2, Cpu)
TREACLE_ENERGY_SUMS(3, Cpu)

}  // namespace treacle
