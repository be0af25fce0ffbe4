#include "treacle/step/readings/balance_sums.hpp"

#include "core/reduce.cuh"

namespace treacle {
namespace {

/// One block per body, its threads stride through all wall particles; reads their bodies, and places, velocities
/// and forces of those of its own, writes the body's sums; no atomics.
template <int D>
__global__ void __launch_bounds__(256) sumLoadsKernel(const __grid_constant__ LoadTerms<D> terms, double* loads) {
  double sums[LoadTerms<D>::count] = {};
  for (std::size_t i = threadIdx.x; i < terms.body.size(); i += 256)
    if (terms.body[i] == blockIdx.x) terms.add(i, sums);
#pragma unroll
  for (int n = 0; n < LoadTerms<D>::count; ++n) {
    const double ofBlock = blockSum(sums[n]);
    if (threadIdx.x == 0) loads[blockIdx.x * LoadTerms<D>::count + n] = ofBlock;
  }
}

}  // namespace

template <int D, class Backend>
std::vector<LoadSums> sumLoads(Context<Backend>& context, const LoadTerms<D>& terms, std::size_t bodies) {
  std::vector<LoadSums> loads(bodies);
  const std::size_t bytes = bodies * sizeof(LoadSums);
  auto* result = static_cast<double*>(context.scratch(bytes));
  launch(context, static_cast<unsigned>(bodies), 256, 0, sumLoadsKernel<D>, terms, result);
  sumOverDevices(context, std::span(result, bodies * LoadTerms<D>::count));
  copyBytesToHost(context, result, loads.data(), bytes);
  return loads;
}

template std::vector<LoadSums> sumLoads(Context<Cuda>&, const LoadTerms<2>&, std::size_t);
template std::vector<LoadSums> sumLoads(Context<Cuda>&, const LoadTerms<3>&, std::size_t);

}  // namespace treacle
