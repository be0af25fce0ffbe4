#include "treacle/step/readings/step_change.hpp"

#include "treacle/core/processes.hpp"

#include <functional>

namespace treacle {

template <int D>
StepChange stepChange(Context<Cpu>& context, const StepChangeTerms<D>& terms) {
  std::array<double, StepChangeTerms<D>::count> sums{};
  for (std::size_t i = 0; i < terms.after.size(); ++i) terms.add(i, sums.data());
  sumOverProcesses(context, std::span<double>(sums));
  return StepChange::mean(sums, joinedOverProcesses(context, terms.after.size(), std::plus<>()));
}

template StepChange stepChange<2>(Context<Cpu>&, const StepChangeTerms<2>&);
template StepChange stepChange<3>(Context<Cpu>&, const StepChangeTerms<3>&);

}  // namespace treacle
