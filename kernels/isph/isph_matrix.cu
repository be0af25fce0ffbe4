#include "core/launch.hpp"
#include "core/scan.hpp"
#include "isph/packed_sums.cuh"
#include "treacle/isph/each_row.hpp"

namespace treacle {
namespace {

/// Lanes that share a row: it has some 25 near neighbours and 57 in all in three dimensions, 9 and 20 in two.
/// Packed entries are four to a load.
constexpr int allLanes = 8, nearLanes = 4, packedAllLanes = 4, packedNearLanes = 2;

/// Entries of a matrix that is not packed: load(k) at once, then what was loaded.
template <class T>
struct PlainEntries {
  IsphMatrix<T> a;
  T inverseUnit;

  struct Entry {
    std::uint32_t column = 0;
    T coefficient = 0;
  };

  explicit PlainEntries(const IsphMatrix<T>& matrix) : a(matrix), inverseUnit(static_cast<T>(1 / matrix.unit)) {}
  __device__ Entry load(std::uint64_t k) const { return {__ldcs(a.column + k), __ldcs(a.coefficient + k)}; }
  __device__ T rounded(const Entry& e) const {
    return static_cast<T>(static_cast<int>(e.coefficient * inverseUnit + T(0.5)));
  }
};

/// sum of entries times x over one section of a row, by every `Lanes`-th entry, `Chunk` of them on their way at a
/// time.
template <int Lanes, int Chunk, bool Near, class X, class T>
__device__ inline X sectionSum(const PlainEntries<T>& e, std::uint64_t section, const X* x) {
  const std::uint64_t begin = e.a.start[section];
  const auto count = static_cast<std::uint32_t>(e.a.start[section + 1] - begin);
  X sum = 0;
  for (std::uint32_t first = threadIdx.x % Lanes; first < count; first += Lanes * Chunk) {
    typename PlainEntries<T>::Entry entry[Chunk];
    X value[Chunk];
#pragma unroll
    for (int c = 0; c < Chunk; ++c)
      if (first + c * Lanes < count) entry[c] = e.load(begin + first + c * Lanes);
#pragma unroll
    for (int c = 0; c < Chunk; ++c) value[c] = first + c * Lanes < count ? x[entry[c].column] : X(0);
#pragma unroll
    for (int c = 0; c < Chunk; ++c) {
      if constexpr (Near)
        sum += e.rounded(entry[c]) * value[c];
      else
        sum += static_cast<double>(entry[c].coefficient) * value[c];
    }
  }
  return sum;
}

/// Eight lanes per row; store(row, sum of c x over all entries), once. Reads the matrix and gathers x. No atomics.
template <class T, class Store>
__global__ void __launch_bounds__(256) allSumsKernel(PlainEntries<T> e, const double* x, Store store) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / allLanes) + threadIdx.x / allLanes;
  double sum = 0;
  if (row < e.a.rows)
    for (const std::uint64_t section : {std::uint64_t{row}, std::uint64_t{e.a.rows} + row})
      sum += sectionSum<allLanes, 4, false>(e, section, x);
  sum = sumOfLanes<allLanes>(sum);
  if (row < e.a.rows && threadIdx.x % allLanes == 0) store(row, sum);
}

/// Four lanes per row; the same over near entries, rounded.
template <class T, class Store>
__global__ void __launch_bounds__(256) nearSumsKernel(PlainEntries<T> e, const T* x, Store store) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / nearLanes) + threadIdx.x / nearLanes;
  T sum = 0;
  if (row < e.a.rows) sum = sectionSum<nearLanes, 8, true>(e, row, x);
  sum = sumOfLanes<nearLanes>(sum);
  if (row < e.a.rows && threadIdx.x % nearLanes == 0) store(row, static_cast<T>(e.a.unit) * sum);
}

}  // namespace

template <class T, class Store>
void nearSums(const Context<Cuda>& context, const IsphMatrix<T>& a, const T* x, Store store) {
  if constexpr (std::is_same_v<T, float>)
    if (a.packed.word) return packedSums<packedNearLanes, true, T>(context, a, x, store);
  launch(context, blocksFor(std::size_t{a.rows} * nearLanes, 256), 256, 0, nearSumsKernel<T, Store>,
         PlainEntries<T>(a), x, store);
}

/// `Staged`: what x is brought together as.
template <class Staged, class T, class Store>
void forEachSum(const Context<Cuda>& context, const IsphMatrix<T>& a, const double* x, Store store) {
  if constexpr (std::is_same_v<T, float>)
    if (a.packed.word) return packedSums<packedAllLanes, false, Staged>(context, a, x, store);
  launch(context, blocksFor(std::size_t{a.rows} * allLanes, 256), 256, 0, allSumsKernel<T, Store>,
         PlainEntries<T>(a), x, store);
}

template <class T, class Backend>
void nearResidual(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> r,
                  std::span<const T> x, std::span<T> res) {
  const T* const inverse = a.inverseNear;
  nearSums(context, a, x.data(), [=] __device__(std::uint32_t i, T sum) {
    const T d = inverse[i];
    res[i] = d > 0 ? static_cast<T>(r[i]) - x[i] / d + sum : T(0);
  });
}

template <class T, class Backend>
void lastSweep(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z) {
  const T* const inverse = a.inverseNear;
  nearSums(context, a, x.data(), [=] __device__(std::uint32_t i, T sum) {
    const T d = inverse[i];
    z[i] = d > 0 ? x[i] + d * (static_cast<T>(r[i]) - x[i] / d + sum) : T(0);
  });
}

/// Twice one thread per row: it counts its entries, then writes them.
template <class T, class Backend>
void compressed(Context<Backend>& context, const IsphMatrix<T>& a, std::uint32_t rows,
                BlockCsr<1, double, Backend>& result) {
  const auto forEachEntry = [a] __device__(std::size_t i, auto&& f) {
    if (i >= a.rows || !(a.diagonal[i] > 0)) return;
    f(static_cast<std::uint32_t>(i), a.diagonal[i]);
    for (const std::size_t section : {i, a.rows + i})
      for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
        if (const double c = a.coefficientAt(section, k); c > 0) f(a.column[k], -c);
  };
  result.rowStart.resize(context, std::size_t{rows} + 1);
  forEach(context, rows, [forEachEntry, start = result.rowStart.data()] __device__(std::size_t i) {
    std::uint64_t entries = 0;
    forEachEntry(i, [&](std::uint32_t, double) { ++entries; });
    start[i] = entries;
  });
  const std::uint64_t entries = startRows(context, result.rowStart);
  result.column.resize(context, entries);
  result.value.resize(context, entries);
  forEach(context, a.rows,
          [forEachEntry, start = result.rowStart.data(), column = result.column.data(),
           block = result.value.data()] __device__(std::size_t i) {
            std::uint64_t place = start[i];
            forEachEntry(i, [&](std::uint32_t j, double value) {
              column[place] = j;
              block[place++].a[0] = value;
            });
          });
}

TREACLE_EACH_ROW(double, Cuda)
TREACLE_EACH_ROW(float, Cuda)

}  // namespace treacle
