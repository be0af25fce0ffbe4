#include "core/each.cuh"
#include "core/list_where.cuh"
#include "treacle/step/each_particle.hpp"

namespace treacle {

TREACLE_EACH_PARTICLE(2, Cuda)
TREACLE_EACH_PARTICLE(3, Cuda)
TREACLE_EACH_TEMPERATURE(Cuda)

}  // namespace treacle
