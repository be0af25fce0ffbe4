#pragma once

#include "treacle/core/cuda.hpp"

#include <cstddef>
#include <vector>

namespace treacle::test {

/// Takes device memory until about so many bytes are free, and holds it.
class MemoryHog {
 public:
  explicit MemoryHog(std::size_t left);
  MemoryHog(const MemoryHog&) = delete;
  MemoryHog& operator=(const MemoryHog&) = delete;
  ~MemoryHog();

  /// Once more: what others have given back since.
  void takeMore();

 private:
  bool take(std::size_t bytes);

  std::size_t left_;
  std::vector<void*> blocks_;
};

/// A kernel that traps, on a stream. Then every call of CUDA fails: for processes that end soon.
void loseDevice(CUstream_st* stream);

/// Counts its executions in `calls`, and in the one after `after` of them writes a NaN to `value`; may be part of
/// a graph. Both in device memory.
void spoil(const Context<Cuda>&, int after, int* calls, double* value);

}  // namespace treacle::test
