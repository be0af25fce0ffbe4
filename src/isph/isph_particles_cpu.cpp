#include "treacle/core/each.hpp"
#include "treacle/isph/each_particle.hpp"
#include "treacle/isph/each_region.hpp"

#include <algorithm>
#include <limits>

namespace treacle {

static double leastWhere(Context<Cpu>&, std::span<const double> x, std::span<const std::uint32_t> label,
                         std::uint32_t of) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x.size(); ++i)
    if (label[i] == of) least = std::min(least, x[i]);
  return least;
}
TREACLE_EACH_NUMBER(Cpu)
TREACLE_EACH_VECTOR(2, Cpu)
TREACLE_EACH_VECTOR(3, Cpu)
TREACLE_EACH_REGION(Cpu)

}  // namespace treacle
