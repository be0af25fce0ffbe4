#include "treacle/step/method/heat_terms.hpp"

#include "core/launch.hpp"
#include "core/reduce_many.cuh"

namespace treacle {

/// One thread per own fluid particle; reads and writes what is its own. No atomics.
template <class Terms>
void setEach(Context<Cuda>& context, const Terms& terms, std::size_t count) {
  forEach(context, count, [terms] __device__(std::size_t i) { terms.set(i); });
}

/// By reduceMany: one thread per own fluid particle, grid-stride; reads its heat.
std::array<double, HeatSums::count> sumHeat(Context<Cuda>& context, const HeatSums& terms) {
  constexpr int count = HeatSums::count;
  using Sums = std::array<double, count>;
  auto* result = static_cast<double*>(context.scratch(sizeof(Sums)));
  reduceMany<count>(
      context, terms.next.size(), [terms] __device__(std::size_t i, double* sums) { terms.add(i, sums); },
      [result] __device__(const double* sums, int lane) {
        if (lane < count) result[lane] = sums[lane];
      });
  return valueOnHost(context, reinterpret_cast<const Sums*>(result));
}

template void setEach(Context<Cuda>&, const HeatSystemTerms&, std::size_t);
template void setEach(Context<Cuda>&, const Difference&, std::size_t);
template void setEach(Context<Cuda>&, const Scaled&, std::size_t);
template void setEach(Context<Cuda>&, const HeatResult&, std::size_t);

}  // namespace treacle
