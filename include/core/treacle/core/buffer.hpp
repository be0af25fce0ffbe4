#pragma once

#include "treacle/core/backend.hpp"

#include <sys/mman.h>
#include <algorithm>
#include <atomic>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace treacle {

/// What all Buffers in host memory of the process have at a time [B]: an account, on which nothing depends.
class HostAccount {
 public:
  static void add(std::size_t bytes) {
    const std::size_t now = live_ += bytes;
    std::size_t peak = peak_;
    while (now > peak && !peak_.compare_exchange_weak(peak, now)) {
    }
  }
  static void subtract(std::size_t bytes) { live_ -= bytes; }
  static std::size_t live() { return live_; }
  /// Since the last call of startPeak().
  static std::size_t peak() { return peak_; }
  static void startPeak() { peak_ = live_.load(); }

 private:
  static inline std::atomic<std::size_t> live_ = 0, peak_ = 0;
};

/// Room for `size` values of a buffer that had `before`: what creeps up does not allocate in every step.
constexpr std::size_t grownCapacity(std::size_t before, std::size_t size) {
  return before == 0 ? size : size + size / 32;
}

/// Host memory aligned to a cache line; large blocks to 2 MiB, with the wish for huge pages: an operator that
/// streams through hundreds of megabytes in every iteration otherwise waits for address translation. Errors:
/// std::bad_alloc.
inline void* hostAllocate(std::size_t bytes) {
  constexpr std::size_t line = 64, huge = std::size_t{2} << 20;
  const std::size_t alignment = bytes >= 2 * huge ? huge : line;
  void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (alignment == huge) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

/// Owner of `size` uninitialised values in a backend's memory. Move-only: copies have a name.
template <class T, class Backend = Cpu>
class Buffer;

/// Host memory, aligned to a cache line (and to the widest vector register).
/// In debug builds fresh floating-point memory is filled with NaN so that a read before a write shows.
/// Errors: std::bad_alloc.
template <class T>
class Buffer<T, Cpu> {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  static constexpr std::size_t alignment = 64;  // [B]

  Buffer() = default;
  explicit Buffer(std::size_t size) { reallocate(size); }
  Buffer(const Context<Cpu>&, std::size_t size) : Buffer(size) {}
  Buffer(Buffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { release(); }

  /// Changes the size; the content is undefined afterwards. Memory is kept while it suffices.
  void resize(std::size_t size) {
    if (size > capacity_) reallocate(grownCapacity(capacity_, size));
    size_ = size;
  }

  /// The same for code that is written for all backends.
  void resize(const Context<Cpu>&, std::size_t size) { resize(size); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  std::span<T> span() { return {data_, size_}; }
  std::span<const T> span() const { return {data_, size_}; }
  operator std::span<T>() { return span(); }
  operator std::span<const T>() const { return span(); }

 private:
  void reallocate(std::size_t size) {
    release();
    if (size > 0) {
      // Rounded up to whole alignment units: vector loads of a partly filled last register stay inside.
      const std::size_t bytes = (size * sizeof(T) + alignment - 1) / alignment * alignment;
      data_ = static_cast<T*>(hostAllocate(bytes));
      HostAccount::add(size * sizeof(T));
#ifndef NDEBUG
      if constexpr (std::is_floating_point_v<T>) std::fill_n(data_, size, std::numeric_limits<T>::quiet_NaN());
#endif
    }
    size_ = capacity_ = size;
  }
  void release() {
    if (data_) {
      std::free(data_);
      HostAccount::subtract(bytes());
    }
    data_ = nullptr;
    size_ = capacity_ = 0;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Up to so many bytes a buffer keeps where it is not needed until the next step: to allocate them anew would take
/// longer than they are worth.
inline constexpr std::size_t keptBytes = std::size_t{32} << 20;

/// Of buffers whose content is no longer needed: gives up what is large, and other arrays take its place.
template <class... Buffers>
void giveUp(Buffers&... buffers) {
  const auto one = [](auto& buffer) {
    if (buffer.bytes() > keptBytes) buffer = {};
  };
  (one(buffers), ...);
}

}  // namespace treacle
