#include "treacle/linear/bucket_cycle.hpp"

#include "core/reduce.cuh"
#include "linear/row_sums.cuh"

namespace treacle {
namespace {

/// One warp per bucket: b = sum of r over its unknowns, and the first sweep from zero, x = D^-1 b. No atomics.
template <int D, class T>
__global__ void restrictKernel(const BucketLevel<D, T> level, const Vec<D, T>* inverse, const Vec<D>* r,
                               const BucketVectors<D, T> v) {
  const std::uint32_t bucket = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (bucket >= level.a.rows) return;
  Vec<D> sum{};
  for (std::uint32_t i = level.members[bucket] + threadIdx.x % 32; i < level.members[bucket + 1]; i += 32)
    for (int k = 0; k < D; ++k) sum[k] += inverse[i][k] == 0 ? 0 : r[i][k];
  Vec<D, T> total;
  for (int k = 0; k < D; ++k) total[k] = static_cast<T>(warpSum(sum[k]));
  if (threadIdx.x % 32 != 0) return;
  v.b[bucket] = total;
  for (int k = 0; k < D; ++k) v.x[bucket][k] = level.inverseDiagonal[bucket][k] * total[k];
}

/// x, or x + P e where there is something coarse.
template <int D, class T, bool Corrected>
struct Iterate {
  static constexpr bool corrected = Corrected;
  const Vec<D, T>* x;
  std::uint32_t rows;
  const std::uint32_t* parent;
  const Vec<D, T>* e;
  std::uint32_t coarseRows;

  __device__ Iterate in(unsigned column) const {
    Iterate i = *this;
    i.x += std::size_t{column} * rows;
    if constexpr (Corrected) i.e += std::size_t{column} * coarseRows;
    return i;
  }
  __device__ T at(std::size_t i, int c) const {
    if constexpr (Corrected) return x[i][c] + e[parent[i]][c];
    return x[i][c];
  }
  __device__ T operator()(T value, const std::uint32_t* column, int c) const { return value * at(*column, c); }
};

/// next = x + D^-1 (b - A x) [K23 eq. (42)]
template <int D, class T, bool Corrected>
struct StoreSweep {
  Iterate<D, T, Corrected> x;
  const Vec<D, T>* b;
  const Vec<D, T>* inverseDiagonal;
  Vec<D, T>* next;

  __device__ StoreSweep in(unsigned column) const {
    const std::size_t skipped = std::size_t{column} * x.rows;
    return {x.in(column), b + skipped, inverseDiagonal, next + skipped};
  }
  __device__ void operator()(std::size_t row, int r, T sum) const {
    next[row][r] = x.at(row, r) + inverseDiagonal[row][r] * (b[row][r] - sum);
  }
};

/// One block per coarse bucket and column, a warp per member at a time: coarse b = sum of b - A x over the
/// members, and the first sweep there. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(256)
    restrictResidualKernel(const BucketLevel<D, T> fine, const BucketVectors<D, T> v,
                           const BucketLevel<D, T> coarse, const BucketVectors<D, T> coarseV) {
  __shared__ Vec<D, T> sums[8];
  const RowLanes<D, 32 / (D * D)> lanes;
  const std::size_t skipped = std::size_t{blockIdx.y} * fine.a.rows;
  const Iterate<D, T, false> iterate{v.x + skipped, fine.a.rows, nullptr, nullptr, 0};
  const Vec<D, T>* b = v.b + skipped;
  const std::uint32_t bucket = blockIdx.x, first = coarse.members[bucket], last = coarse.members[bucket + 1];
  const int warp = threadIdx.x / 32;
  T sum = 0;
  for (std::uint32_t i = first + warp; i < last; i += 8) {
    const T product = lanes.template sum<Reading::Cached>(fine.a, i, lanes.group == 0, iterate);
    if (lanes.holdsSum()) sum += b[i][lanes.r()] - product;
  }
  if (lanes.holdsSum()) sums[warp][lanes.r()] = sum;
  __syncthreads();
  if (threadIdx.x >= D) return;
  const int r = static_cast<int>(threadIdx.x);
  T total = 0;
  for (int w = 0; w < 8; ++w) total += sums[w][r];
  const std::size_t place = std::size_t{blockIdx.y} * coarse.a.rows + bucket;
  coarseV.b[place][r] = total;
  coarseV.x[place][r] = coarse.inverseDiagonal[bucket][r] * total;
}

}  // namespace

template <int D, class T, class Backend>
void bucketRestrict(Context<Backend>& context, const BucketLevel<D, T>& level, std::span<const Vec<D, T>> inverse,
                    std::span<const Vec<D>> r, const BucketVectors<D, T>& v) {
  launch(context, blocksFor(level.a.rows, 4), 128, 0, restrictKernel<D, T>, level, inverse.data(), r.data(), v);
}

/// One thread per number of all columns.
template <int D, class T, class Backend>
void bucketUnits(Context<Backend>& context, const BucketLevel<D, T>& level, std::uint32_t first,
                 const BucketVectors<D, T>& v) {
  const std::size_t n = std::size_t{D} * level.a.rows;
  forEach(context, n * v.columns,
          [n, first, inverse = reinterpret_cast<const T*>(level.inverseDiagonal), b = reinterpret_cast<T*>(v.b),
           x = reinterpret_cast<T*>(v.x)] __device__(std::size_t k) {
            const bool one = k % n == first + k / n;
            b[k] = one ? 1 : 0;
            x[k] = one ? inverse[k % n] : 0;
          });
}

template <int D, class T, class Backend>
void bucketSweep(Context<Backend>& context, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                 const BucketCorrection<D, T>* correction) {
  const auto sweep = [&](const auto& x) {
    using Store = StoreSweep<D, T, std::decay_t<decltype(x)>::corrected>;
    rowSums<Reading::Cached>(context, level.a, x, Store{x, v.b, level.inverseDiagonal, v.next}, v.columns);
  };
  if (correction)
    sweep(
        Iterate<D, T, true>{v.x, level.a.rows, correction->level.parent, correction->e, correction->level.a.rows});
  else
    sweep(Iterate<D, T, false>{v.x, level.a.rows, nullptr, nullptr, 0});
}

template <int D, class T, class Backend>
void bucketRestrictResidual(Context<Backend>& context, const BucketLevel<D, T>& level,
                            const BucketVectors<D, T>& v, const BucketLevel<D, T>& coarse,
                            const BucketVectors<D, T>& coarseV) {
  launch(context, dim3(coarse.a.rows, v.columns), 256, 0, restrictResidualKernel<D, T>, level, v, coarse, coarseV);
}

/// One thread per pair of entries.
template <class T, class Backend>
void symmetrise(Context<Backend>& context, std::uint32_t rows, T* matrix) {
  const std::size_t n = rows;
  forEach(context, n * n, [=] __device__(std::size_t k) {
    const std::size_t i = k / n, j = k % n;
    if (i < j) matrix[i * n + j] = matrix[j * n + i] = (matrix[i * n + j] + matrix[j * n + i]) / 2;
  });
}

#define TREACLE_INSTANTIATE(T)     \
  TREACLE_BUCKET_CYCLE(1, T, Cuda) \
  TREACLE_BUCKET_CYCLE(2, T, Cuda) \
  TREACLE_BUCKET_CYCLE(3, T, Cuda) \
  template void symmetrise(Context<Cuda>&, std::uint32_t, T*);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
