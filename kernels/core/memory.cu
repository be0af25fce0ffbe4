#include "treacle/core/cuda.hpp"

#include "cuda_check.hpp"

namespace treacle {
namespace {

#ifndef NDEBUG
/// One thread per 4 bytes; writes the pattern of a NaN, in float and in double, so that a read before a write
/// shows.
__global__ void fillWithNaN(unsigned* words, std::size_t count) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i < count) words[i] = 0x7ff80000u | 0x7fc00000u;
}
#endif

}  // namespace

Context<Cuda>::Context() { TREACLE_CUDA_CHECK(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }

Context<Cuda>::~Context() {
  if (stream_) cudaStreamDestroy(stream_);
}

void Context<Cuda>::synchronize() const { TREACLE_CUDA_CHECK(cudaStreamSynchronize(stream_)); }

void* deviceAllocate(const Context<Cuda>& context, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* memory = nullptr;
  const cudaError_t status = cudaMallocAsync(&memory, bytes, context.stream());
  if (status == cudaErrorMemoryAllocation) {
    cudaGetLastError();  // the error is reported here and must not meet the next call
    throw std::bad_alloc();
  }
  TREACLE_CUDA_CHECK(status);
#ifndef NDEBUG
  const std::size_t words = bytes / sizeof(unsigned);
  if (words > 0)
    fillWithNaN<<<static_cast<unsigned>((words + 255) / 256), 256, 0, context.stream()>>>(
        static_cast<unsigned*>(memory), words);
  TREACLE_CUDA_CHECK(cudaGetLastError());
#endif
  return memory;
}

void deviceRelease(const Context<Cuda>& context, void* memory) noexcept {
  cudaFreeAsync(memory, context.stream());
}

void copyBytesToDevice(const Context<Cuda>& context, const void* host, void* device, std::size_t bytes) {
  TREACLE_CUDA_CHECK(cudaMemcpyAsync(device, host, bytes, cudaMemcpyHostToDevice, context.stream()));
  context.synchronize();
}

void copyBytesToHost(const Context<Cuda>& context, const void* device, void* host, std::size_t bytes) {
  TREACLE_CUDA_CHECK(cudaMemcpyAsync(host, device, bytes, cudaMemcpyDeviceToHost, context.stream()));
  context.synchronize();
}

}  // namespace treacle
