#include "treacle/step/readings/balance_sums.hpp"

#include "treacle/core/processes.hpp"

namespace treacle {

template <int D>
std::array<double, PowerTerms<D>::count> sumPowers(Context<Cpu>& context, const PowerTerms<D>& terms,
                                                   std::size_t active) {
  std::array<double, PowerTerms<D>::count> sums{};
  for (std::size_t i = 0; i < terms.ownFluid; ++i) terms.add(i, sums.data());
  for (std::size_t i = terms.fluidCount; i < active; ++i) terms.add(i, sums.data());
  sumOverProcesses(context, std::span<double>(sums));
  return sums;
}

template <int D>
std::vector<LoadSums> sumLoads(Context<Cpu>& context, const LoadTerms<D>& terms, std::size_t bodies) {
  std::vector<LoadSums> loads(bodies);
  for (std::size_t i = 0; i < terms.body.size(); ++i)
    terms.add(i, reinterpret_cast<double*>(&loads[terms.body[i]]));
  sumOverProcesses(context, std::span(reinterpret_cast<double*>(loads.data()), bodies * LoadTerms<D>::count));
  return loads;
}

#define TREACLE_INSTANTIATE(D)                                                                        \
  template std::array<double, PowerTerms<D>::count> sumPowers<D>(Context<Cpu>&, const PowerTerms<D>&, \
                                                                 std::size_t);                        \
  template std::vector<LoadSums> sumLoads<D>(Context<Cpu>&, const LoadTerms<D>&, std::size_t);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
