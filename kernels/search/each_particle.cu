#include "core/launch.hpp"
#include "core/list_where.cuh"
#include "treacle/search/each_particle.hpp"

namespace treacle {

TREACLE_EACH_PARTICLE(2, Cuda)
TREACLE_EACH_PARTICLE(3, Cuda)
TREACLE_EACH_BUCKET(Cuda)

}  // namespace treacle
