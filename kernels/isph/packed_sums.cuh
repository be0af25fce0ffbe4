#pragma once

#include "core/launch.hpp"
#include "treacle/isph/isph_matrix.hpp"

namespace treacle {

template <int Lanes, class X>
__device__ inline X sumOfLanes(X sum) {
  for (int s = Lanes / 2; s > 0; s /= 2) sum += __shfl_xor_sync(~0u, sum, s);
  return sum;
}

/// Coefficient of a packed entry: in whole units for smoothers, else in parts of one, as it is.
template <bool Near, class X>
__device__ inline X packedCoefficient(std::uint32_t word) {
  if constexpr (Near) {
    return static_cast<X>(PackedEntry::whole(word));
  } else {
    // A number among the low bits of 2^52 is 2^52 and that number: one addition instead of a slow conversion.
    return __hiloint2double(0x43300000, static_cast<int>(PackedEntry::value(word))) - 4503599627370496.0;
  }
}

/// One lane's share of a row, or of its near section: every `Lanes`-th four. The first `Fours` of them are on
/// their way when this has been made.
template <int Lanes, int Fours, bool Near>
struct PackedShare {
  const uint4* fours;
  std::uint32_t nearBegin = 0, near = 0, farBegin = 0, all = 0;
  uint4 first[Fours] = {};

  __device__ PackedShare(const PackedEntriesView& packed, std::uint32_t rows, std::uint32_t row)
      : fours(reinterpret_cast<const uint4*>(packed.word)) {
    if (row >= rows) return;
    nearBegin = packed.four[row];
    all = near = packed.four[row + 1] - nearBegin;
    if (!Near) {
      farBegin = packed.four[rows + row] - near;  // less the near ones, which come before
      all = packed.four[rows + row + 1] - farBegin;
    }
#pragma unroll
    for (int c = 0; c < Fours; ++c) first[c] = load(threadIdx.x % Lanes + c * Lanes);
  }
  __device__ uint4 load(std::uint32_t k) const {
    return k < all ? fours[k < near ? nearBegin + k : farBegin + k] : uint4{};
  }

  /// Sum of c x. `staged`: x at the columns of the row's block.
  template <class X, class Staged>
  __device__ X sum(const Staged* staged) const {
    X result = 0;
#pragma unroll
    for (int c = 0; c < Fours; ++c) add(first[c], staged, result);
    for (std::uint32_t k = threadIdx.x % Lanes + Fours * Lanes; k < all; k += Lanes) add(load(k), staged, result);
    return result;
  }
  template <class X, class Staged>
  __device__ static void add(const uint4& four, const Staged* staged, X& sum) {
    for (const std::uint32_t word : {four.x, four.y, four.z, four.w})
      sum += packedCoefficient<Near, X>(word) * static_cast<X>(staged[PackedEntry::place(word)]);
  }
};

/// Brings x at the columns of a block together, sixteen lanes per run.
template <class Staged, class X>
__device__ inline void stageColumns(const ColumnBlocksView& blocks, std::uint32_t block,
                                    const ColumnBlocksView::Size& size, const X* x, Staged* staged) {
  constexpr std::uint32_t lanes = 16, chunk = 4;
  const ColumnBlocksView::Run* run = blocks.run + std::size_t{block} * ColumnBlocksView::runs;
  for (std::uint32_t r = threadIdx.x / lanes; r < size.runs; r += blockDim.x / lanes) {
    const std::uint32_t begin = run[r].begin, place = run[r].place;
    const std::uint32_t length = (r + 1 < size.runs ? run[r + 1].place : size.columns) - place;
    for (std::uint32_t k = threadIdx.x % lanes; k < length; k += lanes * chunk) {
      Staged value[chunk];
#pragma unroll
      for (std::uint32_t c = 0; c < chunk; ++c)
        value[c] = k + c * lanes < length ? static_cast<Staged>(x[begin + k + c * lanes]) : Staged(0);
#pragma unroll
      for (std::uint32_t c = 0; c < chunk; ++c)
        if (k + c * lanes < length) staged[place + k + c * lanes] = value[c];
    }
  }
}

/// The same where the block has no places.
template <int Lanes, bool Near, class T, class X>
__device__ inline X scatteredSum(const IsphMatrix<T>& a, std::uint32_t row, const X* x) {
  X sum = 0;
  for (std::uint64_t section = row; section < 2 * std::uint64_t{a.rows}; section += a.rows) {
    const std::uint64_t begin = a.start[section], end = a.start[section + 1];
    const std::uint32_t* word = a.packed.word + a.packed.begin(section);
    for (std::uint64_t k = begin + threadIdx.x % Lanes; k < end; k += Lanes)
      sum += packedCoefficient<Near, X>(word[k - begin]) * x[a.column[k]];
    if (Near) break;
  }
  return sum;
}

/// One block per block of rows, Lanes threads to a row: store(row, sum of c x) over all entries of a row, or over
/// the near ones, rounded; once. Reads the matrix, and x once per block, as numbers of the type `Staged`. No
/// atomics.
template <int Lanes, bool Near, class Staged, class T, class X, class Store>
__global__ void __launch_bounds__(256, Near ? 6 : 5) packedSumsKernel(IsphMatrix<T> a, const X* x, Store store) {
  using Blocks = ColumnBlocksView;
  using Share = PackedShare<Lanes, 4, Near>;
  __shared__ Staged staged[Blocks::columns];
  constexpr std::uint32_t rowsAtOnce = 256 / Lanes;
  std::uint32_t row = blockIdx.x * Blocks::rows + threadIdx.x / Lanes;
  Share share(a.packed, a.rows, row);  // while columns are brought together
  const Blocks::Size size = a.packed.blocks.size[blockIdx.x];
  stageColumns(a.packed.blocks, blockIdx.x, size, x, staged);
  __syncthreads();
  const X unit = static_cast<X>(Near ? a.unit : a.unit / PackedEntry::parts);
  for (std::uint32_t r = 0;; row += rowsAtOnce) {
    X sum = 0;
    if (row < a.rows) sum = size.runs > 0 ? share.template sum<X>(staged) : scatteredSum<Lanes, Near>(a, row, x);
    sum = sumOfLanes<Lanes>(sum);
    if (row < a.rows && threadIdx.x % Lanes == 0) store(row, unit * sum);
    if ((r += rowsAtOnce) >= Blocks::rows) return;
    share = Share(a.packed, a.rows, row + rowsAtOnce);
  }
}

template <int Lanes, bool Near, class Staged, class T, class X, class Store>
void packedSums(const Context<Cuda>& context, const IsphMatrix<T>& a, const X* x, Store store) {
  launch(context, blocksFor(a.rows, ColumnBlocksView::rows), 256, 0,
         packedSumsKernel<Lanes, Near, Staged, T, X, Store>, a, x, store);
}

}  // namespace treacle
