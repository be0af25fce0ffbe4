#include "core/cuda_check.hpp"

#include "treacle/core/cuda.hpp"

#include <string>
#include <string_view>

namespace treacle {
namespace {

/// As in the repository; the folder that this was built in says nothing to the user.
std::string_view placeIn(std::string_view file) {
  const std::size_t begin = file.rfind("kernels/");
  return begin == std::string_view::npos ? file : file.substr(begin);
}

}  // namespace

void throwCudaError(cudaError_t error, const char* file, int line) {
  cudaGetLastError();                        // it is reported here and must not meet the next call
  if (error == cudaErrorMemoryAllocation) {  // kernels and graphs need memory, too
    DeviceMemoryNumbers numbers;
    if (cudaMemGetInfo(&numbers.free, &numbers.total) != cudaSuccess) cudaGetLastError();
    throw DeviceMemoryExhausted(numbers);
  }
  throw DeviceFailure(std::string("the GPU failed: ") + cudaGetErrorString(error) + " (" +
                      cudaGetErrorName(error) + ", noticed at " + std::string(placeIn(file)) + ":" +
                      std::to_string(line) + ")");
}

}  // namespace treacle
