#include "treacle/step/readings/balance_sums.hpp"

#include "treacle/core/processes.hpp"

namespace treacle {

template <int D, class Backend>
std::vector<LoadSums> sumLoads(Context<Backend>& context, const LoadTerms<D>& terms, std::size_t bodies) {
  std::vector<LoadSums> loads(bodies);
  for (std::size_t i = 0; i < terms.body.size(); ++i)
    terms.add(i, reinterpret_cast<double*>(&loads[terms.body[i]]));
  sumOverProcesses(context, std::span(reinterpret_cast<double*>(loads.data()), bodies * LoadTerms<D>::count));
  return loads;
}

template std::vector<LoadSums> sumLoads(Context<Cpu>&, const LoadTerms<2>&, std::size_t);
template std::vector<LoadSums> sumLoads(Context<Cpu>&, const LoadTerms<3>&, std::size_t);

}  // namespace treacle
