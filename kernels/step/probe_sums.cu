#include "treacle/step/readings/probe_sums.hpp"

#include "core/reduce_many.cuh"

#include <array>

namespace treacle {

/// One thread per fluid particle, grid-stride; reads its fields where it is in the part; no atomics but those of
/// the reduction.
template <int D>
PartSums sumPart(Context<Cuda>& context, const PartTerms<D>& terms) {
  constexpr int count = static_cast<int>(PartSums::count);
  auto* result = static_cast<double*>(context.scratch(sizeof(PartSums)));
  reduceMany<count>(
      context, terms.position.size(), [terms] __device__(std::size_t i, double* sums) { terms.add(i, sums); },
      [result] __device__(const double* sums, int lane) {
        if (lane < count) result[lane] = sums[lane];
      });
  return valueOnHost(context, reinterpret_cast<const PartSums*>(result));
}

template PartSums sumPart(Context<Cuda>&, const PartTerms<2>&);
template PartSums sumPart(Context<Cuda>&, const PartTerms<3>&);

}  // namespace treacle
