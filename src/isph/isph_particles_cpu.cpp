#include "treacle/core/each.hpp"
#include "treacle/isph/each_particle.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace treacle {

template <class Backend>
double levelOf(Context<Backend>& context, Level level, std::span<const double> x) {
  if (level == Level::Least) {
    double least = std::numeric_limits<double>::infinity();
    for (const double value : x) least = std::min(least, value);
    return joinedOverProcesses(context, least, [](double a, double b) { return std::min(a, b); });
  }
  const double sum = sumOverProcesses(context, std::accumulate(x.begin(), x.end(), 0.0));
  return sum / static_cast<double>(joinedOverProcesses(context, x.size(), std::plus<>()));
}

TREACLE_EACH_NUMBER(Cpu)
TREACLE_EACH_VECTOR(2, Cpu)
TREACLE_EACH_VECTOR(3, Cpu)

}  // namespace treacle
