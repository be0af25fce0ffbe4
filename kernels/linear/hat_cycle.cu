#include "treacle/linear/hat_cycle.hpp"

#include "core/reduce.cuh"
#include "linear/row_sums.cuh"

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

/// store(k, number k of A x) for all numbers
template <class T, int B, class Store>
void products(const Context<Cuda>& context, const BlockCsrView<B, T>& a, const T* x, Store store) {
  rowSums<Reading::Cached>(context, a, CachedProduct<T, B>{x},
                           [store] __device__(std::size_t row, int r, T sum) { store(row * B + r, sum); });
}

template <class T>
struct StoreProduct {
  T* y;
  __device__ void operator()(std::size_t k, T sum) const { y[k] = sum; }
};

template <class T>
struct StoreResidual {
  const T* from;
  T* res;
  __device__ void operator()(std::size_t k, T sum) const { res[k] = from[k] - sum; }
};

/// res = from - A z, next z = previous z + gain / hatLambdaMax D^-1 res, x += next z
template <class T>
struct StoreStep {
  ChebyshevStep<T> step;
  const T *inverseDiagonal, *from, *z;
  T *res, *next, *x;

  __device__ void operator()(std::size_t k, T sum) const {
    const T rest = from[k] - sum;
    const T change = step.previous * z[k] + step.gain / hatLambdaMax * inverseDiagonal[k] * rest;
    res[k] = rest;
    next[k] = change;
    x[k] += change;
  }
};

/// z = x = gain / hatLambdaMax D^-1 b of the first step
template <class T>
struct FirstStep {
  const T* inverseDiagonal;
  T *z, *x;

  explicit FirstStep(const HatVectors<T>& v) : inverseDiagonal(v.inverseDiagonal), z(v.z[0]), x(v.x) {}
  __device__ void operator()(std::size_t k, T b) const {
    const T change = ChebyshevStep<T>::at(1).gain / hatLambdaMax * inverseDiagonal[k] * b;
    z[k] = change;
    x[k] = change;
  }
};

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

template <class T, int B>
void hatValues(Context<Cuda>& context, const BlockCsr<B, double, Cuda>& a, std::span<Block<B, T>> value,
               std::span<T> inverseDiagonal) {
  launch(context, blocksFor(a.rows(), 4), 128, 0, valuesKernel<T, B>, viewOf(a),
         value.empty() ? nullptr : value.data(), inverseDiagonal.data());
}

template <class T, int B>
void hatMultiply(Context<Cuda>& context, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y) {
  products(context, a, x.data(), StoreProduct<T>{y.data()});
}

template <class T>
void hatFirstStep(Context<Cuda>& context, std::size_t unknowns, const HatVectors<T>& v) {
  forEach(context, unknowns, [b = v.b, step = FirstStep<T>(v)] __device__(std::size_t i) { step(i, b[i]); });
}

template <class T, int B>
void hatStep(Context<Cuda>& context, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last) {
  const T* z = v.z[last];
  products(context, a, z, StoreStep<T>{step, v.inverseDiagonal, from, z, v.res, v.z[1 - last], v.x});
}

template <class T, int B>
void hatResidual(Context<Cuda>& context, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from,
                 int last) {
  products(context, a, v.z[last], StoreResidual<T>{from, v.res});
}

template <int D, int B, class T>
void hatRestrict(Context<Cuda>& context, const HatNodes<D, Cuda>& fine, const HatNodes<D, Cuda>& coarse,
                 const T* res, const HatVectors<T>& v) {
  launchEarly(context, blocksFor(coarse.count(), 4), 128, 0, restrictKernel<D, B, T>, fine.view(), coarse.view(),
              res, v.b, FirstStep<T>(v));
}

template <int D, int B, class T>
void hatProlong(Context<Cuda>& context, const HatNodes<D, Cuda>& fine, const HatNodes<D, Cuda>& coarse, const T* e,
                const HatVectors<T>& v) {
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

template <class T>
void denseMultiply(Context<Cuda>& context, std::uint32_t rows, const T* matrix, const T* b, T* x) {
  launchEarly(context, blocksFor(rows, 4), 128, 0, denseKernel<T>, static_cast<int>(rows), matrix, b, x);
}

#define TREACLE_INSTANTIATE(T)                                                      \
  template void hatFirstStep<T>(Context<Cuda>&, std::size_t, const HatVectors<T>&); \
  template void denseMultiply<T>(Context<Cuda>&, std::uint32_t, const T*, const T*, T*);
#define TREACLE_INSTANTIATE_PRODUCTS(T, B)                                                                       \
  template void hatValues<T, B>(Context<Cuda>&, const BlockCsr<B, double, Cuda>&, std::span<Block<B, T>>,        \
                                std::span<T>);                                                                   \
  template void hatMultiply<T, B>(Context<Cuda>&, const BlockCsrView<B, T>&, std::span<const T>, std::span<T>);  \
  template void hatStep<T, B>(Context<Cuda>&, const BlockCsrView<B, T>&, ChebyshevStep<T>, const HatVectors<T>&, \
                              const T*, int);                                                                    \
  template void hatResidual<T, B>(Context<Cuda>&, const BlockCsrView<B, T>&, const HatVectors<T>&, const T*, int);
#define TREACLE_INSTANTIATE_TRANSFERS(D, B, T)                                                                    \
  template void hatRestrict<D, B, T>(Context<Cuda>&, const HatNodes<D, Cuda>&, const HatNodes<D, Cuda>&,          \
                                     const T*, const HatVectors<T>&);                                             \
  template void hatProlong<D, B, T>(Context<Cuda>&, const HatNodes<D, Cuda>&, const HatNodes<D, Cuda>&, const T*, \
                                    const HatVectors<T>&);
#define TREACLE_INSTANTIATE_ALL(T)       \
  TREACLE_INSTANTIATE(T)                 \
  TREACLE_INSTANTIATE_PRODUCTS(T, 1)     \
  TREACLE_INSTANTIATE_PRODUCTS(T, 2)     \
  TREACLE_INSTANTIATE_PRODUCTS(T, 3)     \
  TREACLE_INSTANTIATE_TRANSFERS(2, 1, T) \
  TREACLE_INSTANTIATE_TRANSFERS(2, 2, T) \
  TREACLE_INSTANTIATE_TRANSFERS(3, 1, T) \
  TREACLE_INSTANTIATE_TRANSFERS(3, 3, T)
TREACLE_INSTANTIATE_ALL(double)
TREACLE_INSTANTIATE_ALL(float)
#undef TREACLE_INSTANTIATE
#undef TREACLE_INSTANTIATE_PRODUCTS
#undef TREACLE_INSTANTIATE_TRANSFERS
#undef TREACLE_INSTANTIATE_ALL

}  // namespace treacle
