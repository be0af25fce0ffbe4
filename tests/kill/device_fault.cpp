// A library to be loaded before CUDA's (LD_PRELOAD) that makes a run meet a fault of the GPU at a chosen moment.
// DEVICE_FAULT=lost:N: before the N-th graph, the solve of about the N-th step, a kernel traps, and the device is
// lost. DEVICE_FAULT=memory:N: from the N-th graph on, pools give no more memory.
#include "support/device_faults.hpp"

#include <cuda_runtime_api.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

/// The function of CUDA that one of this library stands before.
template <class F>
F* next(const char* name) {
  void* const found = dlsym(RTLD_NEXT, name);
  if (!found) std::fprintf(stderr, "device_fault: no %s: CUDA is not a shared library here\n", name), std::abort();
  return reinterpret_cast<F*>(found);
}

struct Fault {
  bool isLoss = false, isMemory = false;
  int graph = 0;

  Fault() {
    const char* text = std::getenv("DEVICE_FAULT");
    const char* number = text ? std::strchr(text, ':') : nullptr;
    if (!number) return;
    isLoss = std::strncmp(text, "lost:", 5) == 0, isMemory = std::strncmp(text, "memory:", 7) == 0;
    graph = std::atoi(number + 1);
  }
};

const Fault& fault() {
  static const Fault only;
  return only;
}

int graphs = 0;  // launched so far; by one thread

}  // namespace

extern "C" cudaError_t cudaGraphLaunch(cudaGraphExec_t graph, cudaStream_t stream) {
  static auto* const real = next<cudaError_t(cudaGraphExec_t, cudaStream_t)>("cudaGraphLaunch");
  if (++graphs == fault().graph && fault().isLoss) treacle::test::loseDevice(stream);
  return real(graph, stream);
}

extern "C" cudaError_t cudaMallocFromPoolAsync(void** memory, size_t bytes, cudaMemPool_t pool,
                                               cudaStream_t stream) {
  static auto* const real =
      next<cudaError_t(void**, size_t, cudaMemPool_t, cudaStream_t)>("cudaMallocFromPoolAsync");
  if (fault().isMemory && graphs >= fault().graph) return cudaErrorMemoryAllocation;
  return real(memory, bytes, pool, stream);
}
