#include "treacle/step/readings/step_change.hpp"

#include "core/reduce_many.cuh"
#include "treacle/core/processes.hpp"

#include <functional>

namespace treacle {

/// By reduceMany: one thread per fluid particle, grid-stride; reads its velocities, writes two sums.
template <int D>
StepChange stepChange(Context<Cuda>& context, const StepChangeTerms<D>& terms) {
  constexpr int count = StepChangeTerms<D>::count;
  using Sums = std::array<double, count>;
  auto* result = static_cast<double*>(context.scratch(sizeof(Sums)));
  reduceMany<count>(
      context, terms.after.size(), [terms] __device__(std::size_t i, double* sums) { terms.add(i, sums); },
      [result] __device__(const double* sums, int lane) {
        if (lane < count) result[lane] = sums[lane];
      });
  return StepChange::mean(valueOnHost(context, reinterpret_cast<const Sums*>(result)),
                          joinedOverProcesses(context, terms.after.size(), std::plus<>()));
}

template StepChange stepChange<2>(Context<Cuda>&, const StepChangeTerms<2>&);
template StepChange stepChange<3>(Context<Cuda>&, const StepChangeTerms<3>&);

}  // namespace treacle
