#pragma once

#include "treacle/core/buffer.hpp"

#include <span>
#include <utility>

struct CUstream_st;

namespace treacle {

/// The stream that everything on a device is ordered by. Move-only. Errors: std::runtime_error with the CUDA
/// message.
template <>
class Context<Cuda> {
 public:
  Context();
  ~Context();
  Context(Context&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
  Context& operator=(Context&& other) noexcept {
    std::swap(stream_, other.stream_);
    return *this;
  }

  CUstream_st* stream() const { return stream_; }
  void synchronize() const;

 private:
  CUstream_st* stream_ = nullptr;
};

/// Stream-ordered memory of the device's pool. Errors: std::bad_alloc when the device has no more.
void* deviceAllocate(const Context<Cuda>&, std::size_t bytes);
void deviceRelease(const Context<Cuda>&, void* memory) noexcept;
void copyBytesToDevice(const Context<Cuda>&, const void* host, void* device, std::size_t bytes);
void copyBytesToHost(const Context<Cuda>&, const void* device, void* host, std::size_t bytes);

/// Device memory; its context must outlive it.
template <class T>
class Buffer<T, Cuda> {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer(const Context<Cuda>& context, std::size_t size)
      : context_(&context), data_(static_cast<T*>(deviceAllocate(context, size * sizeof(T)))), size_(size) {}
  Buffer(Buffer&& other) noexcept
      : context_(other.context_),
        data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~Buffer() {
    if (data_) deviceRelease(*context_, data_);
  }

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  std::span<T> span() { return {data_, size_}; }
  std::span<const T> span() const { return {data_, size_}; }

 private:
  const Context<Cuda>* context_;
  T* data_;
  std::size_t size_;
};

/// Copies by name: both wait until the data are there.
template <class T>
Buffer<T, Cuda> copyToDevice(const Context<Cuda>& context, std::span<const T> host) {
  Buffer<T, Cuda> device(context, host.size());
  copyBytesToDevice(context, host.data(), device.span().data(), device.bytes());
  return device;
}

template <class T>
Buffer<T> copyToHost(const Context<Cuda>& context, const Buffer<T, Cuda>& device) {
  Buffer<T> host(device.size());
  copyBytesToHost(context, device.span().data(), host.data(), device.bytes());
  return host;
}

}  // namespace treacle
