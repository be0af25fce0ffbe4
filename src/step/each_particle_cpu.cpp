#include "treacle/core/each.hpp"
#include "treacle/step/each_particle.hpp"

namespace treacle {

TREACLE_EACH_PARTICLE(2, Cpu)
TREACLE_EACH_PARTICLE(3, Cpu)
TREACLE_EACH_TEMPERATURE(Cpu)

}  // namespace treacle
