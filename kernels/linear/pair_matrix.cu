#include "treacle/linear/pair_matrix.hpp"

#include "core/scan.cuh"

namespace treacle {
namespace {

/// Lanes that share a row: rows have some 25 near neighbours and 57 in all in three dimensions, 9 and 18 in two.
constexpr int rowLanes = 8;

/// Eight lanes per row; store(row, sum of c x over the row's near or all entries), once. Reads the matrix and
/// gathers x. No atomics.
template <bool Near, class T, class X, class Store>
__global__ void __launch_bounds__(256) pairSumsKernel(PairMatrix<T> a, const X* x, Store store) {
  const std::uint32_t row = (blockIdx.x * blockDim.x + threadIdx.x) / rowLanes, lane = threadIdx.x % rowLanes;
  X sum = 0;
  if (row < a.rows) {
    const std::uint64_t begin = a.rowStart[row];
    const std::uint32_t count = Near ? a.nearCount[row] : static_cast<std::uint32_t>(a.rowStart[row + 1] - begin);
    const std::uint32_t* column = a.column + begin;
    const T* coefficient = a.coefficient + begin;
#pragma unroll 4
    for (std::uint32_t k = lane; k < count; k += rowLanes)
      sum += static_cast<X>(__ldcs(coefficient + k)) * x[__ldcs(column + k)];
  }
  for (int s = rowLanes / 2; s > 0; s /= 2) sum += __shfl_xor_sync(~0u, sum, s);
  if (row < a.rows && lane == 0) store(row, sum);
}

template <bool Near, class T, class X, class Store>
void pairSums(const Context<Cuda>& context, const PairMatrix<T>& a, const X* x, Store store) {
  launch(context, blocksFor(std::size_t{a.rows} * rowLanes, 256), 256, 0, pairSumsKernel<Near, T, X, Store>, a, x,
         store);
}

}  // namespace

template <class T>
void multiply(Context<Cuda>& context, const PairMatrix<T>& a, std::span<const double> x, std::span<double> y) {
  pairSums<false>(context, a, x.data(),
                  [diagonal = a.diagonal, x = x.data(), y = y.data()] __device__(std::uint32_t i, double sum) {
                    y[i] = diagonal[i] * x[i] - sum;
                  });
}

template <class T>
void firstSweep(Context<Cuda>& context, const PairMatrix<T>& a, std::span<const double> r, std::span<T> x) {
  forEach(context, a.rows, [inverse = a.inverseNear, r = r.data(), x = x.data()] __device__(std::size_t i) {
    x[i] = inverse[i] * static_cast<T>(r[i]);
  });
}

template <class T>
void nearResidual(Context<Cuda>& context, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res) {
  pairSums<true>(
      context, a, x.data(),
      [inverse = a.inverseNear, r = r.data(), x = x.data(), res = res.data()] __device__(std::uint32_t i, T sum) {
        const T d = inverse[i];
        res[i] = d > 0 ? static_cast<T>(r[i]) - x[i] / d + sum : T(0);
      });
}

template <class T>
void lastSweep(Context<Cuda>& context, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z) {
  pairSums<true>(
      context, a, x.data(),
      [inverse = a.inverseNear, r = r.data(), x = x.data(), z = z.data()] __device__(std::uint32_t i, T sum) {
        const T d = inverse[i];
        z[i] = d > 0 ? x[i] + d * (static_cast<T>(r[i]) - x[i] / d + sum) : T(0);
      });
}

template <class T>
void jacobi(Context<Cuda>& context, const PairMatrix<T>& a, std::span<const double> r, std::span<double> z) {
  forEach(context, a.rows, [diagonal = a.diagonal, r = r.data(), z = z.data()] __device__(std::size_t i) {
    z[i] = diagonal[i] > 0 ? r[i] / diagonal[i] : 0;
  });
}

/// Twice one thread per row: it counts its entries, then writes them.
template <class T>
void compressed(Context<Cuda>& context, const PairMatrix<T>& a, BlockCsr<1, double, Cuda>& result) {
  result.rowStart.resize(context, std::size_t{a.rows} + 1);
  forEach(context, a.rows, [a, start = result.rowStart.data()] __device__(std::size_t i) {
    std::uint64_t entries = a.diagonal[i] > 0;
    for (std::uint64_t k = a.rowStart[i]; a.diagonal[i] > 0 && k < a.rowStart[i + 1]; ++k)
      entries += a.coefficient[k] > 0;
    start[i] = entries;
  });
  const std::uint64_t entries = startRows(context, result.rowStart);
  result.column.resize(context, entries);
  result.block.resize(context, entries);
  forEach(context, a.rows,
          [a, start = result.rowStart.data(), column = result.column.data(),
           block = result.block.data()] __device__(std::size_t i) {
            if (!(a.diagonal[i] > 0)) return;
            std::uint64_t place = start[i];
            column[place] = static_cast<std::uint32_t>(i);
            block[place++].a[0] = a.diagonal[i];
            for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k) {
              if (!(a.coefficient[k] > 0)) continue;
              column[place] = a.column[k];
              block[place++].a[0] = -static_cast<double>(a.coefficient[k]);
            }
          });
}

#define TREACLE_INSTANTIATE(T)                                                                                  \
  template void multiply<T>(Context<Cuda>&, const PairMatrix<T>&, std::span<const double>, std::span<double>);  \
  template void firstSweep<T>(Context<Cuda>&, const PairMatrix<T>&, std::span<const double>, std::span<T>);     \
  template void nearResidual<T>(Context<Cuda>&, const PairMatrix<T>&, std::span<const double>,                  \
                                std::span<const T>, std::span<T>);                                              \
  template void lastSweep<T>(Context<Cuda>&, const PairMatrix<T>&, std::span<const double>, std::span<const T>, \
                             std::span<double>);                                                                \
  template void jacobi<T>(Context<Cuda>&, const PairMatrix<T>&, std::span<const double>, std::span<double>);    \
  template void compressed<T>(Context<Cuda>&, const PairMatrix<T>&, BlockCsr<1, double, Cuda>&);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
