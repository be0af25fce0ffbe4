#include "lane_sums.hpp"
#include "treacle/mph/elasticity_sums.hpp"

namespace treacle {

TREACLE_ELASTICITY_SUMS(2, Cpu)
TREACLE_ELASTICITY_SUMS(3, Cpu)

}  // namespace treacle
