#pragma once

#include "core/cuda_check.hpp"
#include "treacle/core/cuda.hpp"

#include <cstddef>
#include <cstdint>

namespace treacle {

inline unsigned blocksFor(std::size_t count, unsigned perBlock) {
  return static_cast<unsigned>((count + perBlock - 1) / perBlock);
}

/// Starts a kernel on the context's stream; nothing for an empty grid. Debug builds wait for it, so that an error
/// shows where it was made (not while a graph is recorded).
template <class... Parameters, class... Arguments>
void launch(const Context<Cuda>& context, dim3 grid, dim3 block, std::size_t sharedBytes,
            void (*kernel)(Parameters...), Arguments&&... arguments) {
  if (grid.x == 0) return;
  kernel<<<grid, block, sharedBytes, context.stream()>>>(static_cast<Parameters>(arguments)...);
  TREACLE_CUDA_CHECK(cudaGetLastError());
#ifndef NDEBUG
  cudaStreamCaptureStatus capture = cudaStreamCaptureStatusNone;
  TREACLE_CUDA_CHECK(cudaStreamIsCapturing(context.stream(), &capture));
  if (capture == cudaStreamCaptureStatusNone) context.synchronize();
#endif
}

/// The same for a loop over [0, count): one thread per element, called with the index.
template <class Body>
__global__ void forEachKernel(std::size_t count, Body body) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i < count) body(i);
}
template <class Body>
void forEach(const Context<Cuda>& context, std::size_t count, Body body) {
  launch(context, blocksFor(count, 256), 256, 0, forEachKernel<Body>, count, body);
}

}  // namespace treacle
