#include "lane_sums.hpp"
#include "treacle/mph/repulsion_sums.hpp"

namespace treacle {

TREACLE_REPULSION_SUMS(2, Cpu)
TREACLE_REPULSION_SUMS(3, Cpu)

}  // namespace treacle
