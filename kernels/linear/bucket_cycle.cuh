#pragma once

#include "core/reduce.cuh"
#include "treacle/linear/block_csr.hpp"

namespace treacle {

/// One level of the V-cycle as kernels see it.
template <int D, class T>
struct CycleLevel {
  std::uint32_t rows;
  const std::uint64_t* rowStart;
  const std::uint32_t* column;
  const Block<D, T>* block;
  const Vec<D, T>* inverseDiagonal;
  const std::uint32_t* members;  // first member of each bucket, and the end
  const std::uint32_t* parent;   // of each member
  int sweeps;
};

/// Lanes that share a row: rows have at most 3^D blocks, those of single numbers (D = 1) up to 27.
template <int D>
inline constexpr int rowLanes = D == 2 ? 4 : 8;

template <int D, class T>
__device__ inline Vec<D, T> sumOverRowLanes(Vec<D, T> v) {
  for (int offset = rowLanes<D> / 2; offset > 0; offset /= 2)
    for (int k = 0; k < D; ++k) v[k] += __shfl_xor_sync(~0u, v[k], offset);
  return v;
}

/// This lane's share of row `row` of A x.
template <int D, class T>
__device__ inline Vec<D, T> rowShare(const CycleLevel<D, T>& a, std::uint32_t row, const Vec<D, T>* x) {
  Vec<D, T> sum{};
  const std::uint64_t end = a.rowStart[row + 1];
  for (std::uint64_t k = a.rowStart[row] + threadIdx.x % rowLanes<D>; k < end; k += rowLanes<D>)
    sum += a.block[k] * x[a.column[k]];
  return sum;
}

/// The same for x + P e, e on the next coarser level.
template <int D, class T>
__device__ inline Vec<D, T> rowShare(const CycleLevel<D, T>& a, std::uint32_t row, const Vec<D, T>* x,
                                     const std::uint32_t* parent, const Vec<D, T>* e) {
  Vec<D, T> sum{};
  const std::uint64_t end = a.rowStart[row + 1];
  for (std::uint64_t k = a.rowStart[row] + threadIdx.x % rowLanes<D>; k < end; k += rowLanes<D>) {
    const std::uint32_t j = a.column[k];
    sum += a.block[k] * (x[j] + e[parent[j]]);
  }
  return sum;
}

template <int D, class T>
__device__ inline Vec<D, T> scaled(const Vec<D, T>& diagonal, const Vec<D, T>& v) {
  Vec<D, T> r;
  for (int k = 0; k < D; ++k) r[k] = diagonal[k] * v[k];
  return r;
}

/// The whole cycle from `levels[0]` down by one block, on vectors in shared memory; every level has its own
/// b, x and next, `vectors` being the room for all of them. b of the first level is given, x is the result.
template <int D, class T>
class BlockCycle {
 public:
  __device__ BlockCycle(const CycleLevel<D, T>* levels, int count, Vec<D, T>* vectors)
      : levels_(levels), count_(count), vectors_(vectors) {}

  __device__ void run() {
    for (int r = 0; r < count_; ++r) {
      firstSweep(r);
      for (int s = 1; s < levels_[r].sweeps; ++s) sweep(r, false);
      if (r + 1 < count_) restrictResidual(r);
    }
    for (int r = count_ - 2; r >= 0; --r)
      for (int s = 0; s < levels_[r].sweeps; ++s) sweep(r, s == 0);
  }
  __device__ Vec<D, T>* b(int level) { return vectors_ + 3 * start(level); }
  __device__ Vec<D, T>* x(int level) { return b(level) + levels_[level].rows; }

 private:
  __device__ std::uint32_t start(int level) const {
    std::uint32_t rows = 0;
    for (int r = 0; r < level; ++r) rows += levels_[r].rows;
    return rows;
  }
  __device__ Vec<D, T>* next(int level) { return x(level) + levels_[level].rows; }

  __device__ void firstSweep(int r) {
    const CycleLevel<D, T>& a = levels_[r];
    for (std::uint32_t i = threadIdx.x; i < a.rows; i += blockDim.x)
      x(r)[i] = scaled(a.inverseDiagonal[i], b(r)[i]);
    __syncthreads();
  }

  /// Rows in steps of the block, so that all lanes of a warp stay together.
  template <class F>
  __device__ void forEachRow(std::uint32_t rows, F&& f) {
    const std::uint32_t perRound = blockDim.x / rowLanes<D>, mine = threadIdx.x / rowLanes<D>;
    for (std::uint32_t base = 0; base < rows; base += perRound) f(base + mine, base + mine < rows);
    __syncthreads();
  }

  __device__ void sweep(int r, bool prolong) {
    const CycleLevel<D, T>& a = levels_[r];
    const Vec<D, T>*from = x(r), *coarse = prolong ? x(r + 1) : nullptr;
    const std::uint32_t* parent = prolong ? levels_[r + 1].parent : nullptr;
    Vec<D, T>*to = next(r), *rhs = b(r);
    forEachRow(a.rows, [&](std::uint32_t i, bool valid) {
      Vec<D, T> share{};
      if (valid) share = prolong ? rowShare(a, i, from, parent, coarse) : rowShare(a, i, from);
      const Vec<D, T> sum = sumOverRowLanes(share);
      if (!valid || threadIdx.x % rowLanes<D> != 0) return;
      const Vec<D, T> old = prolong ? from[i] + coarse[parent[i]] : from[i];
      to[i] = old + scaled(a.inverseDiagonal[i], rhs[i] - sum);
    });
    for (std::uint32_t i = threadIdx.x; i < a.rows; i += blockDim.x) x(r)[i] = to[i];
    __syncthreads();
  }

  __device__ void restrictResidual(int r) {
    const CycleLevel<D, T>&a = levels_[r], &coarse = levels_[r + 1];
    const Vec<D, T>*from = x(r), *rhs = b(r);
    forEachRow(coarse.rows, [&](std::uint32_t p, bool valid) {
      Vec<D, T> share{}, sumOfB{};
      for (std::uint32_t i = valid ? coarse.members[p] : 0, end = valid ? coarse.members[p + 1] : 0; i < end;
           ++i) {
        share += rowShare(a, i, from);
        sumOfB += rhs[i];
      }
      const Vec<D, T> sum = sumOverRowLanes(share);
      if (valid && threadIdx.x % rowLanes<D> == 0) b(r + 1)[p] = sumOfB - sum;
    });
  }

  const CycleLevel<D, T>* levels_;
  int count_;
  Vec<D, T>* vectors_;
};

}  // namespace treacle
