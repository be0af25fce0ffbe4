#include "core/reduce.cuh"
#include "linear/row_sums.cuh"
#include "treacle/linear/hat_rows.hpp"

namespace treacle {
namespace {

/// The term of A x for numbers that are read again soon.
template <class T, int B>
struct CachedProduct {
  const T* x;
  __device__ T operator()(T value, const std::uint32_t* column, int c) const {
    return value * x[std::size_t{*column} * B + c];
  }
};

}  // namespace

template <class T, int B, class Store>
void forEachProduct(const Context<Cuda>& context, const BlockCsrView<B, T>& a, const T* x, Store store) {
  rowSums<Reading::Cached>(context, a, CachedProduct<T, B>{x},
                           [store] __device__(std::size_t row, int r, T sum) { store(row * B + r, sum); });
}

namespace {

/// One warp per block row; reads A; writes the values and the inverses of the diagonal elements. No atomics.
template <class T, int B>
__global__ void valuesKernel(BlockCsrView<B, double> a, Block<B, T>* value, T* inverseDiagonal) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= a.rows) return;
  constexpr unsigned elements = B * B;
  const std::uint64_t begin = a.rowStart[row];
  const double* from = a.value[begin].a;
  const auto numbers = static_cast<std::uint32_t>(a.rowStart[row + 1] - begin) * elements;
  double diagonal[B] = {};
  for (std::uint32_t k = threadIdx.x % 32; k < numbers; k += 32) {
    const double v = from[k];
    const bool own = a.column[begin + k / elements] == row;
#pragma unroll
    for (int c = 0; c < B; ++c)
      if (own && k % elements == c * (B + 1u)) diagonal[c] = v;
    if (value) value[begin + k / elements].a[k % elements] = static_cast<T>(v);
  }
#pragma unroll
  for (int c = 0; c < B; ++c) {
    const double d = warpSum(diagonal[c]);
    if (threadIdx.x % 32 == 0) inverseDiagonal[std::size_t{row} * B + c] = d > 0 ? static_cast<T>(1 / d) : T(0);
  }
}

/// One warp per coarse node, a lane per fine one around it: b = P^T res, and the first smoothing step unless the
/// level is the dense one. No atomics.
template <int D, int B, class T>
__global__ void restrictKernel(const HatNodesView<D> fine, const HatNodesView<D> coarse, const T* res, T* b,
                               const FirstStep<T> first) {
  waitForEarlierKernels();
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  const int lane = static_cast<int>(threadIdx.x % 32);
  if (row >= coarse.count) return;
  Vec<D, int> p{};
  double weight;
  const bool exists = lane < fineSteps<D> && finePoint(fine.lattice, coarse.pointOf(row), lane, p, weight);
  const std::uint32_t i = exists ? fine.at(p) : noNode;
  for (int c = 0; c < B; ++c) {
    const T sum = warpSum(i >= fine.own ? T(0) : static_cast<T>(weight) * res[std::size_t{i} * B + c]);
    if (lane != c) continue;
    b[std::size_t{row} * B + c] = sum;
    if (first.inverseDiagonal) first(std::size_t{row} * B + c, sum);
  }
}

/// One warp per row: x = M b. No atomics.
template <class T>
__global__ void denseKernel(int unknowns, const T* matrix, const T* b, T* x) {
  waitForEarlierKernels();
  const int row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= unknowns) return;
  T sum = 0;
  const T* mine = matrix + static_cast<std::size_t>(row) * unknowns;
#pragma unroll 8
  for (int k = threadIdx.x % 32; k < unknowns; k += 32) sum += mine[k] * b[k];
  sum = warpSum(sum);
  if (threadIdx.x % 32 == 0) x[row] = sum;
}

}  // namespace

template <class T, int B, class Backend>
void hatValues(Context<Backend>& context, const BlockCsr<B, double, Backend>& a, std::span<Block<B, T>> value,
               std::span<T> inverseDiagonal) {
  launch(context, blocksFor(a.rows(), 4), 128, 0, valuesKernel<T, B>, viewOf(a),
         value.empty() ? nullptr : value.data(), inverseDiagonal.data());
}

template <int D, int B, class T, class Backend>
void hatRestrict(Context<Backend>& context, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                 const T* res, const HatVectors<T>& v) {
  launchEarly(context, blocksFor(coarse.count(), 4), 128, 0, restrictKernel<D, B, T>, fine.view(), coarse.view(),
              res, v.b, FirstStep<T>(v));
}

template <int D, int B, class T, class Backend>
void hatProlong(Context<Backend>& context, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                const T* e, const HatVectors<T>& v) {
  forEach(context, std::size_t{B} * fine.count(),
          [to = fine.view(), from = coarse.view(), e, z = v.z[0], x = v.x] __device__(std::size_t k) {
            const std::uint32_t row = static_cast<std::uint32_t>(k / B), c = static_cast<std::uint32_t>(k % B);
            T sum = 0;
            forEachCoarse(to.lattice, to.pointOf(row), [&](const Vec<D, int>& p, double weight) {
              sum += static_cast<T>(weight) * e[std::size_t{from.at(p)} * B + c];
            });
            z[k] = sum;
            x[k] += sum;
          });
}

template <class T, class Backend>
void denseMultiply(Context<Backend>& context, std::uint32_t rows, const T* matrix, const T* b, T* x) {
  launchEarly(context, blocksFor(rows, 4), 128, 0, denseKernel<T>, static_cast<int>(rows), matrix, b, x);
}

TREACLE_HAT_CYCLE(double, Cuda)
TREACLE_HAT_CYCLE(float, Cuda)

}  // namespace treacle
