#include "core/launch.hpp"

#include <cstdint>
#include <cstdlib>
#include <utility>

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

cudaMemPool_t makePool() {
  int device = 0;
  TREACLE_CUDA_CHECK(cudaGetDevice(&device));
  cudaMemPoolProps properties{};
  properties.allocType = cudaMemAllocationTypePinned;
  properties.location = {cudaMemLocationTypeDevice, device};
  cudaMemPool_t pool = nullptr;
  TREACLE_CUDA_CHECK(cudaMemPoolCreate(&pool, &properties));
  // What is freed stays in the pool: the next step asks for it again.
  std::uint64_t keep = ~std::uint64_t{0};
  TREACLE_CUDA_CHECK(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &keep));
  return pool;
}

}  // namespace

Context<Cuda>::Context(bool usesGraphs) noexcept : usesGraphs_(usesGraphs) {}

/// The other constructor has made a whole object: where something fails here, the destructor gives back the rest.
Context<Cuda>::Context() : Context(std::getenv("TREACLE_NO_GRAPHS") == nullptr) {
  TREACLE_CUDA_CHECK(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  pool_ = makePool();
  partialSums_ = static_cast<double*>(deviceAllocate(*this, (maxPartialSums + maxJointSums) * sizeof(double)));
  ticket_ = static_cast<unsigned*>(deviceAllocate(*this, sizeof(unsigned)));
  clearBytes(*this, ticket_, sizeof(unsigned));
}

Context<Cuda>::~Context() {
  for (void* memory : {static_cast<void*>(partialSums_), static_cast<void*>(ticket_), scratch_})
    if (memory) deviceRelease(*this, memory);
  if (stream_) cudaStreamSynchronize(stream_);
  if (pool_) cudaMemPoolDestroy(pool_);
  if (stream_) cudaStreamDestroy(stream_);
}

void Context<Cuda>::synchronize() const { TREACLE_CUDA_CHECK(cudaStreamSynchronize(stream_)); }

std::size_t Context<Cuda>::peakBytes() const {
  std::uint64_t peak = 0;
  TREACLE_CUDA_CHECK(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemHigh, &peak));
  return peak;
}

void* Context<Cuda>::scratch(std::size_t bytes) {
  if (bytes > scratchBytes_) {
    if (scratch_) deviceRelease(*this, scratch_);
    scratch_ = nullptr;
    scratchBytes_ = 0;
    scratch_ = deviceAllocate(*this, bytes);
    scratchBytes_ = bytes;
  }
  return scratch_;
}

void Context<Cuda>::giveUpScratch() {
  if (scratchBytes_ <= keptBytes) return;
  deviceRelease(*this, std::exchange(scratch_, nullptr));
  scratchBytes_ = 0;
}

void* deviceAllocate(const Context<Cuda>& context, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* memory = nullptr;
  const auto allocate = [&] {
    const cudaError_t status = cudaMallocFromPoolAsync(&memory, bytes, context.pool(), context.stream());
    if (status == cudaErrorMemoryAllocation)
      cudaGetLastError();  // it is reported here and must not meet the next call
    return status;
  };
  cudaError_t status = allocate();
  if (status == cudaErrorMemoryAllocation) {
    // What the pool has kept in pieces that are too small is given back, and may do as a whole.
    context.synchronize();
    TREACLE_CUDA_CHECK(cudaMemPoolTrimTo(context.pool(), 0));
    status = allocate();
  }
  if (status == cudaErrorMemoryAllocation) {
    DeviceMemoryNumbers numbers{bytes, 0, 0, context.peakBytes()};
    TREACLE_CUDA_CHECK(cudaMemGetInfo(&numbers.free, &numbers.total));
    throw DeviceMemoryExhausted(numbers);
  }
  TREACLE_CUDA_CHECK(status);
#ifndef NDEBUG
  const std::size_t words = bytes / sizeof(unsigned);
  launch(context, blocksFor(words, 256), 256, 0, fillWithNaN, static_cast<unsigned*>(memory), words);
#endif
  return memory;
}

void deviceRelease(const Context<Cuda>& context, void* memory) noexcept {
  cudaFreeAsync(memory, context.stream());
}

void copyBytesToDevice(const Context<Cuda>& context, const void* host, void* device, std::size_t bytes) {
  if (bytes == 0) return;
  TREACLE_CUDA_CHECK(cudaMemcpyAsync(device, host, bytes, cudaMemcpyHostToDevice, context.stream()));
  context.synchronize();
}

void copyBytesToHost(const Context<Cuda>& context, const void* device, void* host, std::size_t bytes) {
  if (bytes == 0) return;
  TREACLE_CUDA_CHECK(cudaMemcpyAsync(host, device, bytes, cudaMemcpyDeviceToHost, context.stream()));
  context.synchronize();
}

void copyBytesOnDevice(const Context<Cuda>& context, const void* from, void* to, std::size_t bytes) {
  if (bytes == 0) return;
  TREACLE_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, context.stream()));
}

void clearBytes(const Context<Cuda>& context, void* memory, std::size_t bytes) {
  if (bytes == 0) return;
  TREACLE_CUDA_CHECK(cudaMemsetAsync(memory, 0, bytes, context.stream()));
}

PinnedMemory::PinnedMemory(void* memory, std::size_t bytes) {
  if (bytes == 0) return;
  if (cudaHostRegister(memory, bytes, cudaHostRegisterDefault) == cudaSuccess)
    memory_ = memory;
  else
    cudaGetLastError();  // the error must not meet the next call
}

PinnedMemory::~PinnedMemory() {
  if (memory_) cudaHostUnregister(memory_);
}

}  // namespace treacle
