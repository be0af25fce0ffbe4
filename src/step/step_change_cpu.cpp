#include "treacle/step/step_change.hpp"

namespace treacle {

template <int D>
StepChange stepChange(Context<Cpu>&, const StepChangeTerms<D>& terms) {
  std::array<double, StepChangeTerms<D>::count> sums{};
  for (std::size_t i = 0; i < terms.after.size(); ++i) terms.add(i, sums.data());
  return StepChange::mean(sums, terms.after.size());
}

template StepChange stepChange<2>(Context<Cpu>&, const StepChangeTerms<2>&);
template StepChange stepChange<3>(Context<Cpu>&, const StepChangeTerms<3>&);

}  // namespace treacle
