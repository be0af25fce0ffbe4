#include "treacle/step/method/heat_terms.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/core/processes.hpp"

namespace treacle {

template <class Terms>
void setEach(Context<Cpu>&, const Terms& terms, std::size_t count) {
  parallelFor(count, parallelGrain, [&](std::size_t i) { terms.set(i); });
}

std::array<double, HeatSums::count> sumHeat(Context<Cpu>& context, const HeatSums& terms) {
  std::array<double, HeatSums::count> sums{};
  for (std::size_t i = 0; i < terms.next.size(); ++i) terms.add(i, sums.data());
  sumOverProcesses(context, std::span<double>(sums));
  return sums;
}

template void setEach(Context<Cpu>&, const HeatSystemTerms&, std::size_t);
template void setEach(Context<Cpu>&, const Difference&, std::size_t);
template void setEach(Context<Cpu>&, const Scaled&, std::size_t);
template void setEach(Context<Cpu>&, const HeatResult&, std::size_t);

}  // namespace treacle
