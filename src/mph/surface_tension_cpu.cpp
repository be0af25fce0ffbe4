#include "lane_sums.hpp"
#include "treacle/mph/surface_sums.hpp"

namespace treacle {

TREACLE_SURFACE_SUMS(2, Cpu)
TREACLE_SURFACE_SUMS(3, Cpu)

}  // namespace treacle
