#pragma once

#include "core/launch.hpp"

#include <cub/device/device_scan.cuh>

namespace treacle {

/// Turns the number of entries of each row, rowStart[0 … rows-1], into the start of each row and the end,
/// rowStart[rows]. Returns the end; the host waits for it.
template <class Count>
Count startRows(Context<Cuda>& context, Buffer<Count, Cuda>& rowStart) {
  std::size_t bytes = 0;
  Count* data = rowStart.data();
  clearBytes(context, data + rowStart.size() - 1, sizeof(Count));  // read, though it does not count
  TREACLE_CUDA_CHECK(cub::DeviceScan::ExclusiveSum(nullptr, bytes, data, data, rowStart.size(), context.stream()));
  TREACLE_CUDA_CHECK(
      cub::DeviceScan::ExclusiveSum(context.scratch(bytes), bytes, data, data, rowStart.size(), context.stream()));
  return valueOnHost(context, data + rowStart.size() - 1);
}

}  // namespace treacle
