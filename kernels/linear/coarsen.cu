#include "core/launch.hpp"
#include "core/scan.hpp"
#include "linear/row_sums.cuh"
#include "treacle/core/error.hpp"
#include "treacle/linear/bucket_cycle.hpp"

#include <string>

namespace treacle {
namespace {

constexpr int coarseWarpsPerBlock = 4;
constexpr std::uint64_t overflow = std::uint64_t{1} << 40;  // counted by a row with too many columns

/// Adjacent buckets, itself included; one lane each. Single numbers may be of two or three dimensions.
template <int D>
constexpr int maxColumns = D == 2 ? 9 : 27;

/// One warp per coarse row; reads the columns of its fine rows and their parents; writes the number of distinct
/// parents to rowStart, or, with Fill, the parents, in the order in which they first appear. No atomics.
template <int D, class T, bool Fill>
__global__ void __launch_bounds__(32 * coarseWarpsPerBlock)
    patternKernel(BlockCsrView<D, T> fine, std::uint32_t rows, const std::uint32_t* members,
                  const std::uint32_t* parent, std::uint64_t* rowStart, std::uint32_t* column) {
  const std::uint32_t row = blockIdx.x * coarseWarpsPerBlock + threadIdx.x / 32;
  if (row >= rows) return;
  const unsigned lane = threadIdx.x % 32;
  std::uint32_t mine = ~0u, found = 0;  // lane n keeps the n-th distinct parent
  const std::uint64_t end = fine.rowStart[members[row + 1]];
  for (std::uint64_t first = fine.rowStart[members[row]]; first < end; first += 32) {
    const auto count = static_cast<std::uint32_t>(min(end - first, std::uint64_t{32}));
    const std::uint32_t parents = lane < count ? parent[fine.column[first + lane]] : 0;
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t p = __shfl_sync(~0u, parents, t);
      if (__any_sync(~0u, mine == p)) continue;
      if (lane == found) mine = p;
      ++found;
    }
  }
  if (Fill) {
    if (lane < found) column[rowStart[row] + lane] = mine;
  } else if (lane == 0) {
    rowStart[row] = found > maxColumns<D> ? overflow : found;
  }
}

/// One block of threads per coarse row, one thread per number of its blocks; reads the fine rows, whose blocks it
/// adds in their order; writes the coarse blocks. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(256)
    valuesKernel(BlockCsrView<D, T> fine, const std::uint32_t* members, const std::uint32_t* parent,
                 const std::uint64_t* rowStart, const std::uint32_t* column, Block<D, T>* block) {
  const std::uint32_t row = blockIdx.x;
  const std::uint64_t start = rowStart[row];
  const auto numbers = static_cast<std::uint32_t>(rowStart[row + 1] - start) * (D * D);
  const std::uint64_t begin = fine.rowStart[members[row]], end = fine.rowStart[members[row + 1]];
  for (std::uint32_t n = threadIdx.x; n < numbers; n += blockDim.x) {
    const std::uint32_t mine = column[start + n / (D * D)], e = n % (D * D);
    T sum = 0;
    for (std::uint64_t k = begin; k < end; ++k)
      if (parent[fine.column[k]] == mine) sum += fine.value[k].a[e];
    block[start].a[n] = sum;
  }
}

}  // namespace

template <int D, class T, class Backend>
void coarsen(Context<Backend>& context, const BlockCsr<D, T, Backend>& fine,
             std::span<const std::uint32_t> members, BlockCsr<D, T, Backend>& coarse) {
  const auto rows = static_cast<std::uint32_t>(members.size() - 1);
  Buffer<std::uint32_t, Cuda> parent(context, fine.rows());
  findParents(context, members, parent);

  const BlockCsrView<D, T> pattern = viewOf(fine);
  const unsigned blocks = blocksFor(rows, coarseWarpsPerBlock), threads = 32 * coarseWarpsPerBlock;
  coarse.rowStart.resize(context, std::size_t{rows} + 1);
  std::uint32_t* none = nullptr;
  launch(context, blocks, threads, 0, patternKernel<D, T, false>, pattern, rows, members.data(), parent.data(),
         coarse.rowStart.data(), none);
  const std::uint64_t entries = startRows(context, coarse.rowStart);
  if (entries >= overflow)
    throw RunError("a bucket of the multigrid couples to more than " + std::to_string(maxColumns<D>) +
                   " buckets of its level");
  coarse.column.resize(context, entries);
  coarse.value.resize(context, entries);
  launch(context, blocks, threads, 0, patternKernel<D, T, true>, pattern, rows, members.data(), parent.data(),
         coarse.rowStart.data(), coarse.column.data());
  launch(context, rows, 256, 0, valuesKernel<D, T>, viewOf(fine), members.data(), parent.data(),
         coarse.rowStart.data(), coarse.column.data(), coarse.value.data());
}

#define TREACLE_INSTANTIATE(D, T)                                                                    \
  template void coarsen(Context<Cuda>&, const BlockCsr<D, T, Cuda>&, std::span<const std::uint32_t>, \
                        BlockCsr<D, T, Cuda>&);
TREACLE_INSTANTIATE(1, double)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(1, float)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
