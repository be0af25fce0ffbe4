#pragma once

#include "treacle/core/backend.hpp"

#include <sys/mman.h>
#include <algorithm>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace treacle {

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

  /// Changes the size; the content is undefined afterwards. Memory is kept while it suffices, and grows by
  /// an eighth more than asked, so that sizes which creep up do not allocate in every step.
  void resize(std::size_t size) {
    if (size > capacity_) reallocate(size_ == 0 ? size : size + size / 8);
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
#ifndef NDEBUG
      if constexpr (std::is_floating_point_v<T>) std::fill_n(data_, size, std::numeric_limits<T>::quiet_NaN());
#endif
    }
    size_ = capacity_ = size;
  }
  void release() {
    if (data_) std::free(data_);
    data_ = nullptr;
    size_ = capacity_ = 0;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace treacle
