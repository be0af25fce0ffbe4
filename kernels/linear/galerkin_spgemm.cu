#include "treacle/linear/galerkin_spgemm.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "linear/row_sums.cuh"
#include "linear/scalar_product.hpp"
#include "treacle/core/error.hpp"
#include "treacle/linear/bucket_cycle.hpp"

#include <limits>
#include <string>

namespace treacle {
namespace {

constexpr int scalarWarpsPerBlock = 8;

/// What kernels write of a scalar matrix.
struct ScalarView {
  std::int32_t* start;
  std::int32_t* column;
  double* value;
};
ScalarView viewOf(ScalarCsr& m) { return {m.start.data(), m.column.data(), m.value.data()}; }

/// One warp per block row; reads its blocks; writes the scalar rows. No atomics.
template <int B>
__global__ void __launch_bounds__(32 * scalarWarpsPerBlock)
    scalarRowsKernel(BlockCsrView<B, double> a, ScalarView to) {
  const std::uint32_t row = blockIdx.x * scalarWarpsPerBlock + threadIdx.x / 32, lane = threadIdx.x % 32;
  if (row >= a.rows) return;
  const std::uint64_t begin = a.rowStart[row];
  const auto length = static_cast<std::uint32_t>(a.rowStart[row + 1] - begin) * B;
  const std::uint64_t base = begin * (B * B);
  if (lane < B) to.start[row * B + lane] = static_cast<std::int32_t>(base + lane * length);
  if (row + 1 == a.rows && lane == B) to.start[a.rows * B] = static_cast<std::int32_t>(base + B * length);
  for (std::uint32_t e = lane; e < length * B; e += 32) {
    const std::uint32_t k = e / (B * B), r = e / B % B, c = e % B;
    const std::uint64_t place = base + r * length + k * B + c;
    to.column[place] = static_cast<std::int32_t>(a.column[begin + k] * B + c);
    to.value[place] = a.value[begin].a[e];
  }
}

/// One thread per block row; reads its first scalar row, columns ascending; writes the number of its blocks to
/// rowStart, or, with Fill, their columns. No atomics.
template <int B, bool Fill>
__global__ void blockColumnsKernel(std::uint32_t rows, ScalarView from, std::uint64_t* rowStart,
                                   std::uint32_t* column) {
  const std::uint32_t row = blockIdx.x * blockDim.x + threadIdx.x;
  if (row >= rows) return;
  const std::int32_t begin = from.start[row * B], count = (from.start[row * B + 1] - begin) / B;
  if (!Fill) rowStart[row] = count;
  for (std::int32_t k = 0; Fill && k < count; ++k)
    column[rowStart[row] + k] = static_cast<std::uint32_t>(from.column[begin + k * B] / B);
}

/// The summation over members: P has a one per row.
template <int B>
void writeSummation(const Context<Cuda>& context, const std::uint32_t* parent, std::int64_t n, ScalarView p) {
  forEach(context, static_cast<std::size_t>(n) + 1, [=] __device__(std::size_t e) {
    p.start[e] = static_cast<std::int32_t>(e);
    if (e == static_cast<std::size_t>(n)) return;
    p.column[e] = static_cast<std::int32_t>(B * parent[e / B] + e % B);
    p.value[e] = 1;
  });
}

/// The scalar rows of a block row have the same pattern, since blocks are full.
template <int B>
void writeBlocks(const Context<Cuda>& context, std::uint32_t rows, ScalarView from, const std::uint64_t* rowStart,
                 Block<B>* block) {
  forEach(context, std::size_t{B} * rows, [=] __device__(std::size_t e) {
    const int r = static_cast<int>(e % B);
    const std::int32_t begin = from.start[e], count = from.start[e + 1] - begin;
    for (std::int32_t k = 0; k < count; ++k) block[rowStart[e / B] + k / B](r, k % B) = from.value[begin + k];
  });
}

/// A number of nonzeros, if cuSPARSE can take it.
std::int64_t countable(std::uint64_t entries) {
  if (entries > std::numeric_limits<std::int32_t>::max())
    throw RunError(
        "a matrix has " + std::to_string(entries) +
        " nonzeros, more than the 32-bit indices of cuSPARSE's products hold; the route 'direct' to the coarse "
        "operators has no such limit");
  return static_cast<std::int64_t>(entries);
}

/// A matrix without entries.
template <int B>
void clear(const Context<Cuda>& context, std::uint32_t rows, BlockCsr<B, double, Cuda>& a) {
  a.rowStart.resize(context, std::size_t{rows} + 1);
  clearBytes(context, a.rowStart.data(), a.rowStart.span().size_bytes());
  a.column.resize(context, 0);
  a.value.resize(context, 0);
}

}  // namespace

template <int B>
struct GalerkinSpgemm<B>::Impl {
  ScalarProduct product;
  ScalarCsr a, p, r, ap, rap;
  Buffer<std::uint32_t, Cuda> parent;

  void setMatrix(const Context<Cuda>& context, const BlockCsr<B, double, Cuda>& fine) {
    const std::int64_t n = std::int64_t{B} * fine.rows();
    a.resize(context, n, n);
    a.reserveEntries(context, countable(fine.value.size() * (B * B)));
    launch(context, blocksFor(fine.rows(), scalarWarpsPerBlock), 32 * scalarWarpsPerBlock, 0, scalarRowsKernel<B>,
           treacle::viewOf(fine), viewOf(a));
  }

  void setSummation(Context<Cuda>& context, std::span<const std::uint32_t> members, std::uint32_t fineRows) {
    const std::int64_t n = std::int64_t{B} * fineRows;
    p.resize(context, n, std::int64_t{B} * static_cast<std::int64_t>(members.size() - 1));
    p.reserveEntries(context, n);
    parent.resize(context, fineRows);
    findParents(context, members, parent);
    writeSummation<B>(context, parent.data(), n, viewOf(p));
  }

  /// coarse = P^T A P with the P that is there.
  void compute(Context<Cuda>& context, const BlockCsr<B, double, Cuda>& fine, BlockCsr<B, double, Cuda>& coarse) {
    setMatrix(context, fine);
    product.transpose(context, p, r);
    product.compute(context, a, p, ap);
    product.compute(context, r, ap, rap);
    takeResult(context, static_cast<std::uint32_t>(p.columns / B), coarse);
  }

  void takeResult(Context<Cuda>& context, std::uint32_t rows, BlockCsr<B, double, Cuda>& coarse) {
    coarse.rowStart.resize(context, std::size_t{rows} + 1);
    std::uint32_t* none = nullptr;
    launch(context, blocksFor(rows, 256), 256, 0, blockColumnsKernel<B, false>, rows, viewOf(rap),
           coarse.rowStart.data(), none);
    const std::uint64_t entries = startRows(context, coarse.rowStart);
    coarse.column.resize(context, entries);
    coarse.value.resize(context, entries);
    launch(context, blocksFor(rows, 256), 256, 0, blockColumnsKernel<B, true>, rows, viewOf(rap),
           coarse.rowStart.data(), coarse.column.data());
    writeBlocks<B>(context, rows, viewOf(rap), coarse.rowStart.data(), coarse.value.data());
  }
};

template <int B>
GalerkinSpgemm<B>::GalerkinSpgemm() = default;
template <int B>
GalerkinSpgemm<B>::GalerkinSpgemm(GalerkinSpgemm&&) noexcept = default;
template <int B>
GalerkinSpgemm<B>& GalerkinSpgemm<B>::operator=(GalerkinSpgemm&&) noexcept = default;
template <int B>
GalerkinSpgemm<B>::~GalerkinSpgemm() = default;

template <int B>
void GalerkinSpgemm<B>::compute(Context<Cuda>& context, const BlockCsr<B, double, Cuda>& fine,
                                std::span<const std::uint32_t> members, BlockCsr<B, double, Cuda>& coarse) {
  if (fine.value.empty()) return clear(context, static_cast<std::uint32_t>(members.size() - 1), coarse);
  if (!impl_) impl_ = std::make_unique<Impl>();  // cuSPARSE is loaded where it is needed
  impl_->setSummation(context, members, fine.rows());
  impl_->compute(context, fine, coarse);
}

template <int B>
std::size_t GalerkinSpgemm<B>::bytes() const {
  if (!impl_) return 0;
  std::size_t sum = impl_->product.bytes() + impl_->parent.bytes();
  for (const ScalarCsr* m : {&impl_->a, &impl_->p, &impl_->r, &impl_->ap, &impl_->rap}) sum += m->bytes();
  return sum;
}

template class GalerkinSpgemm<1>;
template class GalerkinSpgemm<2>;
template class GalerkinSpgemm<3>;

}  // namespace treacle
