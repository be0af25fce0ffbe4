#include "treacle/core/each.hpp"
#include "treacle/search/each_particle.hpp"

namespace treacle {

TREACLE_EACH_PARTICLE(2, Cpu)
TREACLE_EACH_PARTICLE(3, Cpu)
TREACLE_EACH_BUCKET(Cpu)

}  // namespace treacle
