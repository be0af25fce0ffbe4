#include "core/each.cuh"
#include "core/list_where.cuh"
#include "treacle/core/processes.hpp"
#include "treacle/isph/each_particle.hpp"
#include "treacle/isph/each_region.hpp"

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_reduce.cuh>

#include <limits>

namespace treacle {
namespace {

/// x where the label is `of`, and infinity elsewhere.
struct Where {
  const double* x;
  const std::uint32_t* label;
  std::uint32_t of;
  __device__ double operator()(std::size_t i) const {
    return label[i] == of ? x[i] : std::numeric_limits<double>::infinity();
  }
};

}  // namespace

static double leastWhere(Context<Cuda>& context, std::span<const double> x, std::span<const std::uint32_t> label,
                         std::uint32_t of) {
  if (x.empty()) return std::numeric_limits<double>::infinity();
  const auto values = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0),
                                                      Where{x.data(), label.data(), of});
  // Behind the partial sums of blocks, until the next reduction.
  double* result = context.partialSums() + Context<Cuda>::maxPartialSums - 1;
  std::size_t bytes = 0;
  TREACLE_CUDA_CHECK(cub::DeviceReduce::Min(nullptr, bytes, values, result, x.size(), context.stream()));
  TREACLE_CUDA_CHECK(
      cub::DeviceReduce::Min(context.scratch(bytes), bytes, values, result, x.size(), context.stream()));
  return valueOnHost(context, result);
}

TREACLE_EACH_NUMBER(Cuda)
TREACLE_EACH_VECTOR(2, Cuda)
TREACLE_EACH_VECTOR(3, Cuda)
TREACLE_EACH_REGION(Cuda)

}  // namespace treacle
