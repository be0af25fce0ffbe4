#pragma once

#include "treacle/core/buffer.hpp"

#include <algorithm>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>

struct CUstream_st;
struct CUmemPoolHandle_st;

namespace treacle {

class DeviceLink;

/// The stream that everything on a device is ordered by, the pool that its memory comes from, and what the
/// reductions on it need. Errors: DeviceMemoryExhausted, DeviceFailure.
template <>
class Context<Cuda> : public Processes {
 public:
  /// The current device.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  CUstream_st* stream() const { return stream_; }
  CUmemPoolHandle_st* pool() const { return pool_; }
  void synchronize() const;

  Halo<Cuda>* halo = nullptr;  // as that of Context<Cpu>
  DeviceLink* link = nullptr;  // to the devices of the other processes, where the simulation has any

  /// Whether iterations run as graphs. The environment variable TREACLE_NO_GRAPHS makes the host launch each
  /// kernel: slower, but debuggers and sanitizers see every launch.
  bool usesGraphs() const { return usesGraphs_; }

  /// Largest amount of device memory that was in use at one time [B].
  std::size_t peakBytes() const;

  /// Temporary memory of at least so many bytes; the next call may hand out the same. Errors: std::bad_alloc.
  void* scratch(std::size_t bytes);
  /// As treacle::giveUp.
  void giveUpScratch();

  /// Room for the partial sums of one reduction, and the counter by which its last block knows itself (zero
  /// between reductions).
  static constexpr std::size_t maxPartialSums = 8192;
  double* partialSums() const { return partialSums_; }
  /// Room for the sums of one reduction while they are added up over processes.
  static constexpr std::size_t maxJointSums = 64;
  double* jointSums() const { return partialSums_ + maxPartialSums; }
  unsigned* ticket() const { return ticket_; }

 private:
  explicit Context(bool usesGraphs) noexcept;

  CUstream_st* stream_ = nullptr;
  CUmemPoolHandle_st* pool_ = nullptr;
  double* partialSums_ = nullptr;
  unsigned* ticket_ = nullptr;
  void* scratch_ = nullptr;
  std::size_t scratchBytes_ = 0;
  bool usesGraphs_ = true;
};

/// What is known where device memory does not suffice [B]; 0: not known.
struct DeviceMemoryNumbers {
  std::size_t wanted = 0;           // at once
  std::size_t free = 0, total = 0;  // of the device
  std::size_t peak = 0;             // largest amount that the context had in use at one time
};

/// The device has not enough memory for what was asked of it. Nothing else is wrong with it.
class DeviceMemoryExhausted : public std::bad_alloc {
 public:
  explicit DeviceMemoryExhausted(const DeviceMemoryNumbers& numbers) : numbers_(numbers) {}

  const DeviceMemoryNumbers& numbers() const { return numbers_; }
  const char* what() const noexcept override { return "device memory exhausted"; }

 private:
  DeviceMemoryNumbers numbers_;
};

/// CUDA reports anything else, a wrong access or a device that is gone: what is in the device's memory is lost,
/// and in most cases the process cannot use the device any more.
class DeviceFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
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

  /// Changes the size; the content is undefined afterwards. Memory is kept while it suffices. Errors:
  /// std::bad_alloc.
  void resize(const Context<Cuda>& context, std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = grownCapacity(capacity_, size);
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
