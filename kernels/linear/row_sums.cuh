#pragma once

#include "core/launch.hpp"
#include "treacle/linear/block_csr.hpp"

namespace treacle {

/// How a row's storage is read: once per product, or again soon, from the cache.
enum class Reading { Streamed, Cached };

/// A warp's lanes in groups of Blocks D^2, one per block row: consecutive lanes read consecutive numbers of the
/// row's storage, so each keeps its place (r, c) within the blocks, and `Blocks` blocks are in work at a time.
template <int D, int Blocks>
struct RowLanes {
  static constexpr int elements = D * D, lanes = Blocks * elements, rowsPerWarp = 32 / lanes;
  int group, beside, e;

  __device__ RowLanes()
      : group(threadIdx.x % 32 / lanes),
        beside(threadIdx.x % 32 % lanes / elements),
        e(threadIdx.x % 32 % lanes % elements) {}
  __device__ int r() const { return e / D; }
  __device__ int c() const { return e % D; }
  /// Whether this lane has the sum of component r() in the end.
  __device__ bool holdsSum() const { return group < rowsPerWarp && beside == 0 && c() == 0; }

  /// Sum of term(A_(r,c), place of the column index, c) over a row; with all lanes of the warp, `used` where the
  /// lane's group has a row.
  template <Reading How, class T, class Term>
  __device__ T sum(const BlockCsrView<D, T>& a, std::uint64_t row, bool used, const Term& term) const {
    T mine = 0;
    if (used) {
      const std::uint64_t begin = a.rowStart[row];
      const auto count = static_cast<std::uint32_t>(a.rowStart[row + 1] - begin);
      const std::uint32_t* column = a.column + begin;
      const T* value = a.value[begin].a + e;
#pragma unroll 8
      for (std::uint32_t k = beside; k < count; k += Blocks)
        mine += term(How == Reading::Streamed ? __ldcs(value + k * elements) : __ldg(value + k * elements),
                     column + k, c());
    }
    // Over the columns of the blocks, then over the blocks side by side.
    T total = mine;
    for (int s = 1; s < D; ++s) total += __shfl_down_sync(~0u, mine, s);
    const T ofBlock = total;
    if constexpr ((Blocks & (Blocks - 1)) == 0)
      for (int s = Blocks / 2; s > 0; s /= 2) total += __shfl_down_sync(~0u, total, s * elements);
    else
      for (int s = 1; s < Blocks; ++s) total += __shfl_down_sync(~0u, ofBlock, s * elements);
    return total;
  }
};

/// What a term or a store is in column `column` of several vectors side by side; those without a member `in` know
/// but one.
template <class F>
__device__ inline F inColumn(const F& f, unsigned column) {
  if constexpr (requires { f.in(column); })
    return f.in(column);
  else
    return f;
}

/// A group of lanes per block row (RowLanes) and column of vectors. Reads the matrix and what `term` reads; writes
/// what `store` writes. No atomics.
template <int D, class T, int Blocks, Reading How, class Term, class Store>
__global__ void __launch_bounds__(256) rowSumsKernel(BlockCsrView<D, T> a, const Term terms, const Store stores) {
  waitForEarlierKernels();
  const Term term = inColumn(terms, blockIdx.y);
  const Store store = inColumn(stores, blockIdx.y);
  const RowLanes<D, Blocks> lanes;
  const std::uint64_t row = (blockIdx.x * std::uint64_t{8} + threadIdx.x / 32) * lanes.rowsPerWarp + lanes.group;
  const bool used = lanes.group < lanes.rowsPerWarp && row < a.rows;
  const T total = lanes.template sum<How>(a, row, used, term);
  if (used && lanes.holdsSum()) store(row, lanes.r(), total);
}

/// For every component r of every block row: store(row, r, sum of term(A_(r,c), place of the column index, c) over
/// the row's blocks and their columns c), for each of `columns` vectors. The order of a sum depends on the matrix
/// alone.
template <Reading How, int D, class T, class Term, class Store>
void rowSums(const Context<Cuda>& context, const BlockCsrView<D, T>& a, Term term, Store store,
             unsigned columns = 1) {
  // As many blocks at a time as a warp has room for; where rows are shorter than that, several rows to a warp.
  constexpr int wide = 32 / (D * D), narrow = D == 1 ? 8 : D == 2 ? 4 : 1;
  const auto start = [&](auto atATime) {
    constexpr int Blocks = decltype(atATime)::value, rowsPerWarp = 32 / (Blocks * D * D);
    launchEarly(context, dim3(blocksFor(a.rows, 8 * rowsPerWarp), columns), 256, 0,
                rowSumsKernel<D, T, Blocks, How, Term, Store>, a, term, store);
  };
  if (2 * a.entries < 3 * wide * std::uint64_t{a.rows})
    start(std::integral_constant<int, narrow>{});
  else
    start(std::integral_constant<int, wide>{});
}

/// The term of a matrix-vector product.
template <int D, class T>
struct ProductWith {
  const Vec<D, T>* x;
  __device__ T operator()(T value, const std::uint32_t* column, int c) const {
    return value * x[__ldcs(column)][c];
  }
};

}  // namespace treacle
