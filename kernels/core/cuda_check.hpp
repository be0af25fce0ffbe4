#pragma once

#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

namespace treacle {

/// Throws with the place and CUDA's own words unless the call succeeded.
inline void cudaCheck(cudaError_t status, const char* file, int line) {
  if (status != cudaSuccess)
    throw std::runtime_error(std::string(file) + ":" + std::to_string(line) +
                             ": CUDA: " + cudaGetErrorString(status));
}

}  // namespace treacle

#define TREACLE_CUDA_CHECK(call) ::treacle::cudaCheck((call), __FILE__, __LINE__)
