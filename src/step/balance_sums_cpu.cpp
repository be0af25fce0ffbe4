#include "treacle/step/balance_sums.hpp"

namespace treacle {

template <int D>
std::array<double, PowerTerms<D>::count> sumPowers(Context<Cpu>&, const PowerTerms<D>& terms, std::size_t active) {
  std::array<double, PowerTerms<D>::count> sums{};
  for (std::size_t i = 0; i < active; ++i) terms.add(i, sums.data());
  return sums;
}

template <int D>
std::vector<LoadSums> sumLoads(Context<Cpu>&, const LoadTerms<D>& terms, std::size_t bodies) {
  std::vector<LoadSums> loads(bodies);
  for (std::size_t i = 0; i < terms.body.size(); ++i)
    terms.add(i, reinterpret_cast<double*>(&loads[terms.body[i]]));
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
