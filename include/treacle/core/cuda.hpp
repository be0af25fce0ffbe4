#pragma once

#include "treacle/core/buffer.hpp"

#include <algorithm>
#include <new>
#include <span>
#include <utility>

struct CUstream_st;
struct CUmemPoolHandle_st;

namespace treacle {

/// The stream that everything on a device is ordered by, the pool that its memory comes from, and what the
/// reductions on it need. Errors: std::runtime_error with the CUDA message.
template <>
class Context<Cuda> {
 public:
  /// The current device.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  CUstream_st* stream() const { return stream_; }
  CUmemPoolHandle_st* pool() const { return pool_; }
  void synchronize() const;

  /// Whether iterations run as graphs. The environment variable TREACLE_NO_GRAPHS makes the host launch each
  /// kernel: slower, but debuggers and sanitizers see every launch.
  bool usesGraphs() const { return usesGraphs_; }

  /// Largest amount of device memory that was in use at one time [B].
  std::size_t peakBytes() const;

  /// Temporary memory of at least so many bytes; the next call may hand out the same. Errors: std::bad_alloc.
  void* scratch(std::size_t bytes);

  /// Room for the partial sums of one reduction, and the counter by which its last block knows itself (zero
  /// between reductions).
  static constexpr std::size_t maxPartialSums = 8192;
  double* partialSums() const { return partialSums_; }
  unsigned* ticket() const { return ticket_; }

 private:
  CUstream_st* stream_ = nullptr;
  CUmemPoolHandle_st* pool_ = nullptr;
  double* partialSums_ = nullptr;
  unsigned* ticket_ = nullptr;
  void* scratch_ = nullptr;
  std::size_t scratchBytes_ = 0;
  bool usesGraphs_ = true;
};

/// The device has not enough memory for what was asked of it.
class DeviceMemoryExhausted : public std::bad_alloc {
 public:
  DeviceMemoryExhausted(std::size_t peak, std::size_t total) : peak_(peak), total_(total) {}

  std::size_t peakBytes() const { return peak_; }    // largest amount that was in use at one time [B]
  std::size_t totalBytes() const { return total_; }  // of the device [B]
  const char* what() const noexcept override { return "device memory exhausted"; }

 private:
  std::size_t peak_, total_;
};

/// Stream-ordered memory of the context's pool. Errors: DeviceMemoryExhausted.
void* deviceAllocate(const Context<Cuda>&, std::size_t bytes);
void deviceRelease(const Context<Cuda>&, void* memory) noexcept;
/// Copies that wait until the data are there.
void copyBytesToDevice(const Context<Cuda>&, const void* host, void* device, std::size_t bytes);
void copyBytesToHost(const Context<Cuda>&, const void* device, void* host, std::size_t bytes);
/// Device to device, and zeros, in the order of the stream.
void copyBytesOnDevice(const Context<Cuda>&, const void* from, void* to, std::size_t bytes);
void clearBytes(const Context<Cuda>&, void* memory, std::size_t bytes);

/// Device memory; its context must outlive it. Move-only: copies have a name.
template <class T>
class Buffer<T, Cuda> {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;
  Buffer(const Context<Cuda>& context, std::size_t size) { resize(context, size); }
  Buffer(Buffer&& other) noexcept
      : context_(other.context_),
        data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  ~Buffer() { release(); }

  /// Changes the size; the content is undefined afterwards. Memory is kept while it suffices, and grows by an
  /// eighth more than asked. Errors: std::bad_alloc.
  void resize(const Context<Cuda>& context, std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = size_ == 0 ? size : size + size / 8;
      release();
      context_ = &context;
      data_ = static_cast<T*>(deviceAllocate(context, capacity * sizeof(T)));
      capacity_ = capacity;
    }
    size_ = size;
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }
  bool empty() const { return size_ == 0; }
  std::span<T> span() { return {data_, size_}; }
  std::span<const T> span() const { return {data_, size_}; }
  operator std::span<T>() { return span(); }
  operator std::span<const T>() const { return span(); }

 private:
  void release() {
    if (data_) deviceRelease(*context_, data_);
    data_ = nullptr;
    size_ = capacity_ = 0;
  }

  const Context<Cuda>* context_ = nullptr;
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Copies by name; they wait until the data are there.
template <class T>
void copyToDevice(const Context<Cuda>& context, std::span<const T> host, Buffer<T, Cuda>& device) {
  device.resize(context, host.size());
  copyBytesToDevice(context, host.data(), device.data(), host.size_bytes());
}
template <class T>
Buffer<T, Cuda> copyToDevice(const Context<Cuda>& context, std::span<const T> host) {
  Buffer<T, Cuda> device;
  copyToDevice(context, host, device);
  return device;
}
template <class T>
void copyToHost(const Context<Cuda>& context, std::span<const T> device, Buffer<T>& host) {
  host.resize(device.size());
  copyBytesToHost(context, device.data(), host.data(), device.size_bytes());
}
template <class T>
Buffer<T> copyToHost(const Context<Cuda>& context, const Buffer<T, Cuda>& device) {
  Buffer<T> host;
  copyToHost(context, device.span(), host);
  return host;
}
/// One value from the device.
template <class T>
T valueOnHost(const Context<Cuda>& context, const T* device) {
  T value;
  copyBytesToHost(context, device, &value, sizeof(T));
  return value;
}

/// Host memory that the device copies to and from without a detour, as long as this object lives. Where the system
/// does not allow that, copies take the detour.
class PinnedMemory {
 public:
  PinnedMemory() = default;
  PinnedMemory(void* memory, std::size_t bytes);
  PinnedMemory(PinnedMemory&& other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
  PinnedMemory& operator=(PinnedMemory&& other) noexcept {
    std::swap(memory_, other.memory_);
    return *this;
  }
  ~PinnedMemory();

 private:
  void* memory_ = nullptr;
};

}  // namespace treacle
