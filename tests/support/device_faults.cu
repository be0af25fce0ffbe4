#include "support/device_faults.hpp"

#include <cuda_runtime.h>

namespace treacle::test {
namespace {

__global__ void trapKernel() { __trap(); }

__global__ void spoilKernel(int after, int* calls, double* value) {
  if ((*calls)++ == after) *value = __longlong_as_double(0x7ff8000000000000);
}

std::size_t freeBytes() {
  std::size_t free = 0, total = 0;
  return cudaMemGetInfo(&free, &total) == cudaSuccess ? free : 0;
}

}  // namespace

MemoryHog::MemoryHog(std::size_t left) : left_(left) { takeMore(); }

MemoryHog::~MemoryHog() {
  for (void* block : blocks_) cudaFree(block);
}

void MemoryHog::takeMore() {
  constexpr std::size_t largest = std::size_t{1} << 36, smallest = std::size_t{1} << 20;
  for (std::size_t bytes = largest; bytes >= smallest; bytes /= 2)
    while (freeBytes() >= left_ + bytes && take(bytes)) {
    }
  // What pools of this process keep without using it is not free, but is given to those who ask.
  if (left_ == 0)
    while (take(2 * smallest)) {
    }
}

bool MemoryHog::take(std::size_t bytes) {
  void* block = nullptr;
  if (cudaMalloc(&block, bytes) == cudaSuccess) {
    blocks_.push_back(block);
    return true;
  }
  cudaGetLastError();  // the error must not meet the next call
  return false;
}

void loseDevice(CUstream_st* stream) { trapKernel<<<1, 1, 0, stream>>>(); }

void spoil(const Context<Cuda>& context, int after, int* calls, double* value) {
  spoilKernel<<<1, 1, 0, context.stream()>>>(after, calls, value);
}

}  // namespace treacle::test
