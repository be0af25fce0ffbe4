#pragma once

#include <cuda_runtime.h>

namespace treacle {

/// Throws DeviceMemoryExhausted or, with CUDA's own words and the place where they were heard, DeviceFailure.
[[noreturn]] void throwCudaError(cudaError_t error, const char* file, int line);

/// Throws unless the call succeeded.
inline void cudaCheck(cudaError_t status, const char* file, int line) {
  if (status != cudaSuccess) throwCudaError(status, file, line);
}

}  // namespace treacle

#define TREACLE_CUDA_CHECK(call) ::treacle::cudaCheck((call), __FILE__, __LINE__)
