#include "core/each.cuh"
#include "treacle/core/processes.hpp"
#include "treacle/isph/each_particle.hpp"

#include <cub/device/device_reduce.cuh>

#include <algorithm>
#include <functional>
#include <limits>

namespace treacle {

template <class Backend>
double levelOf(Context<Backend>& context, Level level, std::span<const double> x) {
  if (level == Level::Mean) {
    const double sum =
        sumEach<1>(context, x.size(), [=] __device__(std::size_t i, double* total) { *total += x[i]; })[0];
    return sum / static_cast<double>(joinedOverProcesses(context, x.size(), std::plus<>()));
  }
  double least = std::numeric_limits<double>::infinity();
  if (!x.empty()) {
    // Behind the partial sums of blocks, until the next reduction.
    double* result = context.partialSums() + Context<Cuda>::maxPartialSums - 1;
    std::size_t bytes = 0;
    TREACLE_CUDA_CHECK(cub::DeviceReduce::Min(nullptr, bytes, x.data(), result, x.size(), context.stream()));
    TREACLE_CUDA_CHECK(
        cub::DeviceReduce::Min(context.scratch(bytes), bytes, x.data(), result, x.size(), context.stream()));
    least = valueOnHost(context, result);
  }
  return joinedOverProcesses(context, least, [](double a, double b) { return std::min(a, b); });
}

TREACLE_EACH_NUMBER(Cuda)
TREACLE_EACH_VECTOR(2, Cuda)
TREACLE_EACH_VECTOR(3, Cuda)

}  // namespace treacle
