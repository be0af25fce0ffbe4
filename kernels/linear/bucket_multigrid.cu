#include "treacle/linear/bucket_multigrid.hpp"

#include "linear/bucket_cycle.cuh"
#include "linear/dense_product.cuh"
#include "linear/parents.cuh"
#include "linear/row_sums.cuh"
#include "treacle/linear/galerkin_spgemm.hpp"

namespace treacle {
namespace {

/// One thread per number.
template <int D, class T>
void convert(Context<Cuda>& context, const BlockCsr<D, double, Cuda>& from, BlockCsr<D, T, Cuda>& to) {
  to.rowStart.resize(context, from.rowStart.size());
  to.column.resize(context, from.column.size());
  to.block.resize(context, from.block.size());
  copyBytesOnDevice(context, from.rowStart.data(), to.rowStart.data(),
                    from.rowStart.size() * sizeof(std::uint64_t));
  copyBytesOnDevice(context, from.column.data(), to.column.data(), from.column.size() * sizeof(std::uint32_t));
  const double* source = reinterpret_cast<const double*>(from.block.data());
  T* target = reinterpret_cast<T*>(to.block.data());
  forEach(context, from.block.size() * D * D,
          [=] __device__(std::size_t k) { target[k] = static_cast<T>(source[k]); });
}

/// Component k of particle i.
template <class V>
struct All {
  const V* r;
  __device__ double operator()(std::uint32_t i, int k) const { return r[i][k]; }
};
/// The same, but nothing of what is not an unknown.
template <int D, class T>
struct Unknowns {
  const Vec<D, T>* inverse;
  const Vec<D>* r;
  __device__ double operator()(std::uint32_t i, int k) const { return inverse[i][k] == 0 ? 0 : r[i][k]; }
};

/// One warp per bucket: b = sum of value(particle, component) over its particles, and the first sweep from zero,
/// x = D^-1 b. No atomics.
template <int D, class T, class Value>
__global__ void restrictKernel(const CycleLevel<D, T> level, const Value value, Vec<D, T>* b, Vec<D, T>* x) {
  const std::uint32_t bucket = (blockIdx.x * blockDim.x + threadIdx.x) / 32;
  if (bucket >= level.rows) return;
  Vec<D> sum{};
  for (std::uint32_t i = level.members[bucket] + threadIdx.x % 32; i < level.members[bucket + 1]; i += 32)
    for (int k = 0; k < D; ++k) sum[k] += value(i, k);
  Vec<D, T> total;
  for (int k = 0; k < D; ++k) total[k] = static_cast<T>(warpSum(sum[k]));
  if (threadIdx.x % 32 != 0) return;
  b[bucket] = total;
  x[bucket] = scaled(level.inverseDiagonal[bucket], total);
}

/// x, or x + P coarse where there is something coarse.
template <int D, class T, bool Prolong>
struct Iterate {
  const Vec<D, T>* x;
  const std::uint32_t* parent;
  const Vec<D, T>* coarse;

  __device__ T at(std::size_t i, int c) const {
    if constexpr (Prolong) return x[i][c] + coarse[parent[i]][c];
    return x[i][c];
  }
  __device__ T operator()(T value, const std::uint32_t* column, int c) const { return value * at(*column, c); }
};

/// next = x + D^-1 (b - A x) [K23 eq. (42)]
template <int D, class T, bool Prolong>
struct StoreSweep {
  Iterate<D, T, Prolong> x;
  const Vec<D, T>* b;
  const Vec<D, T>* inverseDiagonal;
  Vec<D, T>* next;

  __device__ void operator()(std::size_t row, int r, T sum) const {
    next[row][r] = x.at(row, r) + inverseDiagonal[row][r] * (b[row][r] - sum);
  }
};

/// One block per coarse bucket, a warp per member at a time: coarse b = sum of b - A x over the members, and the
/// first sweep there. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(256)
    restrictResidualKernel(const BlockCsrView<D, T> a, const Vec<D, T>* b, const Vec<D, T>* x,
                           const CycleLevel<D, T> coarse, Vec<D, T>* coarseB, Vec<D, T>* coarseX) {
  __shared__ Vec<D, T> sums[8];
  const RowLanes<D, 32 / (D * D)> lanes;
  const Iterate<D, T, false> iterate{x, nullptr, nullptr};
  const std::uint32_t bucket = blockIdx.x, first = coarse.members[bucket], last = coarse.members[bucket + 1];
  const int warp = threadIdx.x / 32;
  T sum = 0;
  for (std::uint32_t i = first + warp; i < last; i += 8) {
    const T product = lanes.template sum<Reading::Cached>(a, i, lanes.group == 0, iterate);
    if (lanes.holdsSum()) sum += b[i][lanes.r()] - product;
  }
  if (lanes.holdsSum()) sums[warp][lanes.r()] = sum;
  __syncthreads();
  if (threadIdx.x >= D) return;
  const int r = static_cast<int>(threadIdx.x);
  T total = 0;
  for (int w = 0; w < 8; ++w) total += sums[w][r];
  coarseB[bucket][r] = total;
  coarseX[bucket][r] = coarse.inverseDiagonal[bucket][r] * total;
}

/// One thread per unknown: z = diag(inverse) r + P x, zero where the inverse is.
template <int D, class T>
__global__ void prolongKernel(std::size_t unknowns, const T* inverse, const double* r,
                              const std::uint32_t* bucketOf, const Vec<D, T>* x, double* z) {
  const std::size_t k = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (k >= unknowns) return;
  z[k] = inverse[k] == 0 ? 0 : inverse[k] * r[k] + x[bucketOf[k / D]][static_cast<int>(k % D)];
}

constexpr int maxDenseLevels = 32;                 // keys have at most 31 levels
constexpr std::size_t maxSharedBytes = 200 << 10;  // of the block that runs the dense part of the cycle
template <int D, class T>
struct CycleLevels {
  CycleLevel<D, T> level[maxDenseLevels];
  int count;
};

/// One block per unit vector: runs the cycle on it and writes the result as a row of the (symmetric) matrix.
template <int D, class T>
__global__ void __launch_bounds__(256)
    denseSetupKernel(const __grid_constant__ CycleLevels<D, T> levels, T* matrix) {
  extern __shared__ double shared[];
  BlockCycle<D, T> cycle(levels.level, levels.count, reinterpret_cast<Vec<D, T>*>(shared));
  const std::uint32_t unknowns = D * levels.level[0].rows;
  T* b = reinterpret_cast<T*>(cycle.b(0));
  for (std::uint32_t k = threadIdx.x; k < unknowns; k += blockDim.x) b[k] = k == blockIdx.x ? 1 : 0;
  __syncthreads();
  cycle.run();
  const T* x = reinterpret_cast<const T*>(cycle.x(0));
  for (std::uint32_t k = threadIdx.x; k < unknowns; k += blockDim.x)
    matrix[static_cast<std::size_t>(blockIdx.x) * unknowns + k] = x[k];
}

/// One thread per pair of entries. The cycle is symmetric but for its rounding errors; as a matrix those would be
/// the same in every application, and CR in single precision stalls on them.
template <class T>
void symmetrise(Context<Cuda>& context, std::uint32_t unknowns, T* matrix) {
  const std::size_t n = unknowns;
  forEach(context, n * n, [=] __device__(std::size_t k) {
    const std::size_t i = k / n, j = k % n;
    if (i < j) matrix[i * n + j] = matrix[j * n + i] = (matrix[i * n + j] + matrix[j * n + i]) / 2;
  });
}

}  // namespace

template <int D, class T>
CycleLevel<D, T> BucketMultigrid<D, T, Cuda>::view(std::size_t r) const {
  const Level& l = levels_[r];
  return {l.a.rows(),       l.a.rowStart.data(), l.a.column.data(), l.a.block.data(), l.inverseDiagonal.data(),
          l.members.data(), l.parent.data(),     l.sweeps};
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::buildLevel(Context<Cuda>& context, std::size_t r,
                                             const BlockCsr<D, double, Cuda>& a) {
  Level& level = levels_[r];
  convert<D, T>(context, a, level.a);
  const std::uint32_t rows = a.rows();
  for (Buffer<Vec<D, T>, Cuda>* v : {&level.inverseDiagonal, &level.b, &level.x, &level.next})
    v->resize(context, rows);
  extendedJacobiInverse<D, T, T>(context, level.a, level.inverseDiagonal);
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::setup(Context<Cuda>& context, const BlockCsr<D, double, Cuda>& finest,
                                        std::vector<std::span<const std::uint32_t>> members,
                                        const CycleSweeps& sweeps, GalerkinSpgemm<D>* spgemm) {
  levels_.resize(members.size());
  for (std::size_t r = 0; r < levels_.size(); ++r) {
    Level& level = levels_[r];
    level.members = members[r];
    const bool coarsest = r + 1 == levels_.size();
    level.sweeps = coarsest ? sweeps.coarsest : r == 0 ? sweeps.finest : sweeps.middle;
    const std::uint32_t memberCount = r == 0 ? valueOnHost(context, &members[0].back()) : levels_[r - 1].a.rows();
    findParents(context, members[r], memberCount, level.parent);
    const BlockCsr<D, double, Cuda>& finer = r == 1 ? finest : levels_[r > 0 ? r - 1 : 0].galerkin;
    if (r > 0 && spgemm)
      spgemm->compute(context, finer, members[r], level.galerkin);
    else if (r > 0)
      coarsen<D, double>(context, finer, members[r], level.galerkin);
    buildLevel(context, r, r == 0 ? finest : level.galerkin);
  }
  buildDense(context);
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::buildDense(Context<Cuda>& context) {
  // Scattered drops have many levels with hardly fewer buckets each: the cycle below must fit into one block, too.
  const auto sharedBytes = [&](std::size_t level) {
    std::size_t rows = 0;
    for (std::size_t r = level; r < levels_.size(); ++r) rows += levels_[r].a.rows();
    return 3 * rows * sizeof(Vec<D, T>);
  };
  denseLevel_ = 0;
  while (denseLevel_ < levels_.size() &&
         (D * levels_[denseLevel_].a.rows() > denseUnknowns || sharedBytes(denseLevel_) > maxSharedBytes))
    ++denseLevel_;
  if (denseLevel_ == levels_.size()) return;  // the last of few levels may be large
  CycleLevels<D, T> levels{};
  for (std::size_t r = denseLevel_; r < levels_.size(); ++r) levels.level[levels.count++] = view(r);
  const std::uint32_t unknowns = D * levels_[denseLevel_].a.rows();
  dense_.resize(context, std::size_t{unknowns} * unknowns);
  const std::size_t shared = sharedBytes(denseLevel_);
  TREACLE_CUDA_CHECK(cudaFuncSetAttribute(denseSetupKernel<D, T>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                          static_cast<int>(shared)));
  launch(context, unknowns, 256, shared, denseSetupKernel<D, T>, levels, dense_.data());
  symmetrise(context, unknowns, dense_.data());
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::cycle(Context<Cuda>& context, std::size_t r) {
  Level& level = levels_[r];
  if (r == denseLevel_) {
    const int unknowns = static_cast<int>(D * level.a.rows());
    launch(context, blocksFor(unknowns, 4), 128, 0, denseKernel<T>, unknowns, dense_.data(),
           reinterpret_cast<const T*>(level.b.data()), reinterpret_cast<T*>(level.x.data()));
    return;
  }
  const auto sweep = [&]<bool Prolong>(const std::uint32_t* parent, const Vec<D, T>* coarse) {
    const Iterate<D, T, Prolong> x{level.x.data(), parent, coarse};
    rowSums<Reading::Cached>(
        context, level.a, x,
        StoreSweep<D, T, Prolong>{x, level.b.data(), level.inverseDiagonal.data(), level.next.data()});
    std::swap(level.x, level.next);
  };
  for (int s = 1; s < level.sweeps; ++s) sweep.template operator()<false>(nullptr, nullptr);
  if (r + 1 == levels_.size()) return;
  Level& coarse = levels_[r + 1];
  launch(context, coarse.a.rows(), 256, 0, restrictResidualKernel<D, T>, viewOf(level.a), level.b.data(),
         level.x.data(), view(r + 1), coarse.b.data(), coarse.x.data());
  cycle(context, r + 1);
  sweep.template operator()<true>(coarse.parent.data(), coarse.x.data());
  for (int s = 1; s < level.sweeps; ++s) sweep.template operator()<false>(nullptr, nullptr);
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::apply(Context<Cuda>& context, std::span<const Vec<D, T>> inverse,
                                        std::span<const Vec<D>> r, std::span<Vec<D>> z) {
  Level& finest = levels_[0];
  const Unknowns<D, T> value{inverse.data(), r.data()};
  launch(context, blocksFor(finest.a.rows(), 4), 128, 0, restrictKernel<D, T, Unknowns<D, T>>, view(0), value,
         finest.b.data(), finest.x.data());
  cycle(context, 0);
  const std::size_t unknowns = r.size() * D;
  launch(context, blocksFor(unknowns, 256), 256, 0, prolongKernel<D, T>, unknowns,
         reinterpret_cast<const T*>(inverse.data()), reinterpret_cast<const double*>(r.data()),
         finest.parent.data(), finest.x.data(), reinterpret_cast<double*>(z.data()));
}

template <int D, class T>
void BucketMultigrid<D, T, Cuda>::correct(Context<Cuda>& context, std::span<const Gathered<D, T>> r,
                                          std::span<Gathered<D, T>> z, std::span<Gathered<D, T>> x) {
  Level& finest = levels_[0];
  const All<Gathered<D, T>> value{r.data()};
  launch(context, blocksFor(finest.a.rows(), 4), 128, 0, restrictKernel<D, T, All<Gathered<D, T>>>, view(0), value,
         finest.b.data(), finest.x.data());
  cycle(context, 0);
  forEach(context, r.size(),
          [coarse = finest.x.data(), bucketOf = finest.parent.data(), z = z.data(),
           x = x.data()] __device__(std::size_t i) {
            const Vec<D, T> e = coarse[bucketOf[i]];
            z[i] = e;
            x[i] += e;
          });
}

template <int D, class T>
std::size_t BucketMultigrid<D, T, Cuda>::bytes() const {
  std::size_t sum = dense_.bytes();
  for (const Level& l : levels_)
    sum += l.galerkin.bytes() + l.a.bytes() + l.inverseDiagonal.bytes() + l.b.bytes() + l.x.bytes() +
           l.next.bytes() + l.parent.bytes();
  return sum;
}

template class BucketMultigrid<1, double, Cuda>;
template class BucketMultigrid<2, double, Cuda>;
template class BucketMultigrid<3, double, Cuda>;
template class BucketMultigrid<1, float, Cuda>;
template class BucketMultigrid<2, float, Cuda>;
template class BucketMultigrid<3, float, Cuda>;

}  // namespace treacle
