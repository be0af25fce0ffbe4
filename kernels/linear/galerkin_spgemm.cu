#include "treacle/linear/galerkin_spgemm.hpp"

#include "core/scan.cuh"
#include "linear/parents.cuh"
#include "linear/row_sums.cuh"
#include "linear/scalar_product.hpp"
#include "treacle/core/error.hpp"

#include <limits>
#include <string>

namespace treacle {
namespace {

constexpr int warpsPerBlock = 8;

/// What kernels write of a scalar matrix.
struct ScalarView {
  std::int32_t* start;
  std::int32_t* column;
  double* value;
};
ScalarView viewOf(ScalarCsr& m) { return {m.start.data(), m.column.data(), m.value.data()}; }

/// One warp per block row; reads its blocks; writes the scalar rows. No atomics.
template <int D>
__global__ void __launch_bounds__(32 * warpsPerBlock) scalarRowsKernel(BlockCsrView<D, double> a, ScalarView to) {
  const std::uint32_t row = blockIdx.x * warpsPerBlock + threadIdx.x / 32, lane = threadIdx.x % 32;
  if (row >= a.rows) return;
  const std::uint64_t begin = a.rowStart[row];
  const auto length = static_cast<std::uint32_t>(a.rowStart[row + 1] - begin) * D;
  const std::uint64_t base = begin * (D * D);
  if (lane < D) to.start[row * D + lane] = static_cast<std::int32_t>(base + lane * length);
  if (row + 1 == a.rows && lane == D) to.start[a.rows * D] = static_cast<std::int32_t>(base + D * length);
  for (std::uint32_t e = lane; e < length * D; e += 32) {
    const std::uint32_t k = e / (D * D), r = e / D % D, c = e % D;
    const std::uint64_t place = base + r * length + k * D + c;
    to.column[place] = static_cast<std::int32_t>(a.column[begin + k] * D + c);
    to.value[place] = a.block[begin].a[e];
  }
}

/// One thread per block row; reads its first scalar row, columns ascending; writes the number of its blocks to
/// rowStart, or, with Fill, their columns. No atomics.
template <int D, bool Fill>
__global__ void blockColumnsKernel(std::uint32_t rows, ScalarView from, std::uint64_t* rowStart,
                                   std::uint32_t* column) {
  const std::uint32_t row = blockIdx.x * blockDim.x + threadIdx.x;
  if (row >= rows) return;
  const std::int32_t begin = from.start[row * D], count = (from.start[row * D + 1] - begin) / D;
  if (!Fill) rowStart[row] = count;
  for (std::int32_t k = 0; Fill && k < count; ++k)
    column[rowStart[row] + k] = static_cast<std::uint32_t>(from.column[begin + k * D] / D);
}

template <int D>
void writeProlongation(const Context<Cuda>& context, const std::uint32_t* parent, std::int64_t n, ScalarView p) {
  forEach(context, static_cast<std::size_t>(n) + 1, [=] __device__(std::size_t e) {
    p.start[e] = static_cast<std::int32_t>(e);
    if (e == static_cast<std::size_t>(n)) return;
    p.column[e] = static_cast<std::int32_t>(D * parent[e / D] + e % D);
    p.value[e] = 1;
  });
}

/// The entries by fine rows, the starts by coarse ones.
template <int D>
void writeRestriction(const Context<Cuda>& context, const std::uint32_t* members, const std::uint32_t* parent,
                      std::int64_t n, std::int64_t coarse, ScalarView r) {
  forEach(context, static_cast<std::size_t>(n), [=] __device__(std::size_t e) {
    const auto i = static_cast<std::uint32_t>(e / D), c = static_cast<std::uint32_t>(e % D);
    const std::uint32_t first = members[parent[i]], count = members[parent[i] + 1] - first;
    const std::uint32_t place = D * first + c * count + (i - first);
    r.column[place] = static_cast<std::int32_t>(e);
    r.value[place] = 1;
  });
  forEach(context, static_cast<std::size_t>(coarse) + 1, [=] __device__(std::size_t e) {
    const bool end = e == static_cast<std::size_t>(coarse);
    const std::uint32_t first = members[e / D], count = end ? 0 : members[e / D + 1] - first;
    r.start[e] = static_cast<std::int32_t>(D * first + e % D * count);
  });
}

/// The scalar rows of a block row have the same pattern, since blocks are full.
template <int D>
void writeBlocks(const Context<Cuda>& context, std::uint32_t rows, ScalarView from, const std::uint64_t* rowStart,
                 Block<D>* block) {
  forEach(context, std::size_t{D} * rows, [=] __device__(std::size_t e) {
    const int r = static_cast<int>(e % D);
    const std::int32_t begin = from.start[e], count = from.start[e + 1] - begin;
    for (std::int32_t k = 0; k < count; ++k) block[rowStart[e / D] + k / D](r, k % D) = from.value[begin + k];
  });
}

}  // namespace

template <int D>
struct GalerkinSpgemm<D>::Impl {
  ScalarProduct product;
  ScalarCsr a, p, r, ap, rap;
  Buffer<std::uint32_t, Cuda> parent;

  void setMatrix(const Context<Cuda>& context, const BlockCsr<D, double, Cuda>& fine) {
    const std::uint64_t entries = fine.block.size() * (D * D);
    if (entries > std::numeric_limits<std::int32_t>::max())
      throw RunError(
          "the system matrix has " + std::to_string(entries) +
          " nonzeros, more than the 32-bit indices of cuSPARSE's products hold; the route 'direct' to the "
          "coarse operators has no such limit");
    const std::int64_t n = std::int64_t{D} * fine.rows();
    a.resize(context, n, n);
    a.reserveEntries(context, static_cast<std::int64_t>(entries));
    launch(context, blocksFor(fine.rows(), warpsPerBlock), 32 * warpsPerBlock, 0, scalarRowsKernel<D>,
           treacle::viewOf(fine), viewOf(a));
  }

  /// P has a one per row; R = P^T has the rows of a coarse row's components behind each other.
  void setTransfer(const Context<Cuda>& context, std::span<const std::uint32_t> members, std::uint32_t fineRows) {
    const std::int64_t n = std::int64_t{D} * fineRows;
    const auto coarse = std::int64_t{D} * static_cast<std::int64_t>(members.size() - 1);
    p.resize(context, n, coarse);
    r.resize(context, coarse, n);
    p.reserveEntries(context, n);
    r.reserveEntries(context, n);
    findParents(context, members, fineRows, parent);
    writeProlongation<D>(context, parent.data(), n, viewOf(p));
    writeRestriction<D>(context, members.data(), parent.data(), n, coarse, viewOf(r));
  }

  void takeResult(Context<Cuda>& context, std::uint32_t rows, BlockCsr<D, double, Cuda>& coarse) {
    coarse.rowStart.resize(context, std::size_t{rows} + 1);
    std::uint32_t* none = nullptr;
    launch(context, blocksFor(rows, 256), 256, 0, blockColumnsKernel<D, false>, rows, viewOf(rap),
           coarse.rowStart.data(), none);
    const std::uint64_t entries = startRows(context, coarse.rowStart);
    coarse.column.resize(context, entries);
    coarse.block.resize(context, entries);
    launch(context, blocksFor(rows, 256), 256, 0, blockColumnsKernel<D, true>, rows, viewOf(rap),
           coarse.rowStart.data(), coarse.column.data());
    writeBlocks<D>(context, rows, viewOf(rap), coarse.rowStart.data(), coarse.block.data());
  }
};

template <int D>
GalerkinSpgemm<D>::GalerkinSpgemm() : impl_(std::make_unique<Impl>()) {}
template <int D>
GalerkinSpgemm<D>::GalerkinSpgemm(GalerkinSpgemm&&) noexcept = default;
template <int D>
GalerkinSpgemm<D>& GalerkinSpgemm<D>::operator=(GalerkinSpgemm&&) noexcept = default;
template <int D>
GalerkinSpgemm<D>::~GalerkinSpgemm() = default;

template <int D>
void GalerkinSpgemm<D>::compute(Context<Cuda>& context, const BlockCsr<D, double, Cuda>& fine,
                                std::span<const std::uint32_t> members, BlockCsr<D, double, Cuda>& coarse) {
  const auto rows = static_cast<std::uint32_t>(members.size() - 1);
  if (fine.block.empty()) {
    coarse.rowStart.resize(context, std::size_t{rows} + 1);
    clearBytes(context, coarse.rowStart.data(), coarse.rowStart.span().size_bytes());
    coarse.column.resize(context, 0);
    coarse.block.resize(context, 0);
    return;
  }
  Impl& m = *impl_;
  m.setMatrix(context, fine);
  m.setTransfer(context, members, fine.rows());
  m.product.compute(context, m.a, m.p, m.ap);
  m.product.compute(context, m.r, m.ap, m.rap);
  m.takeResult(context, rows, coarse);
}

template <int D>
std::size_t GalerkinSpgemm<D>::bytes() const {
  std::size_t sum = impl_->product.bytes() + impl_->parent.bytes();
  for (const ScalarCsr* m : {&impl_->a, &impl_->p, &impl_->r, &impl_->ap, &impl_->rap}) sum += m->bytes();
  return sum;
}

template class GalerkinSpgemm<2>;
template class GalerkinSpgemm<3>;

}  // namespace treacle
