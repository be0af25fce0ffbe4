#include "core/scan.hpp"

#include "core/cuda_check.hpp"

#include <cub/device/device_scan.cuh>

namespace treacle {

// CUB's templates take a compiler a quarter of a minute: this is the only file with them.

template <class Count>
void sumBefore(Context<Cuda>& context, std::span<Count> value) {
  std::size_t bytes = 0;
  Count* data = value.data();
  TREACLE_CUDA_CHECK(cub::DeviceScan::ExclusiveSum(nullptr, bytes, data, data, value.size(), context.stream()));
  TREACLE_CUDA_CHECK(
      cub::DeviceScan::ExclusiveSum(context.scratch(bytes), bytes, data, data, value.size(), context.stream()));
}
template void sumBefore(Context<Cuda>&, std::span<std::uint32_t>);
template void sumBefore(Context<Cuda>&, std::span<std::uint64_t>);

void sumUpTo(Context<Cuda>& context, std::span<std::uint64_t> value) {
  std::size_t bytes = 0;
  std::uint64_t* data = value.data();
  TREACLE_CUDA_CHECK(cub::DeviceScan::InclusiveSum(nullptr, bytes, data, data, value.size(), context.stream()));
  TREACLE_CUDA_CHECK(
      cub::DeviceScan::InclusiveSum(context.scratch(bytes), bytes, data, data, value.size(), context.stream()));
}

}  // namespace treacle
