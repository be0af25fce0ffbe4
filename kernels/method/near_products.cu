#include "treacle/method/near_products.hpp"

#include "core/scan.cuh"
#include "method/pair_device.cuh"
#include "method/pair_terms.cuh"

namespace treacle {
namespace {

constexpr unsigned slice = 32;

/// One thread per particle, a warp per slice; reads cluster lists and positions. Without Fill writes the rows of
/// its slice, with Fill its entries. Walls list fluid alone. No atomics.
template <int D, bool Fill>
__global__ void __launch_bounds__(128)
    listKernel(const __grid_constant__ MphPairs<D> pairs, std::uint64_t* sliceStart, ListEntry* entry) {
  const std::uint32_t index = blockIdx.x * blockDim.x + threadIdx.x, s = index / slice;
  if (s * slice >= pairs.activeCount) return;
  const std::uint32_t i = min(index, pairs.activeCount - 1);
  const bool valid = index < pairs.activeCount, wall = i >= pairs.fluidCount;
  const ClusterListView& list = wall ? pairs.wallList : pairs.fluidList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  const Vec<D> xi = positionInCluster(pairs, list.first + cluster * clusterSize, i);
  const double h2 = pairs.pressureWeight.radius * pairs.pressureWeight.radius;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  std::uint32_t count = 0;
  const std::uint64_t base = Fill ? sliceStart[s] * slice + index % slice : 0;
  for (const ListSegment segment : {ListSegment::NearFluid, ListSegment::NearWall}) {
    if (!valid || (wall && segment == ListSegment::NearWall)) continue;
    const std::uint64_t end = offset[static_cast<int>(segment) + 1];
    for (std::uint64_t k = offset[static_cast<int>(segment)]; k < end; ++k) {
      const ListEntry e = list.entry[k];
      if (e.index() == i || norm2(pairs.positionOf(e) - xi) >= h2) continue;
      if (Fill)
        entry[base + std::uint64_t{slice} * count] = imageFrom(pairs, i, list.first + cluster * clusterSize, e);
      ++count;
    }
  }
  if (Fill) {
    const auto rows = static_cast<std::uint32_t>(sliceStart[s + 1] - sliceStart[s]);
    for (; count < rows; ++count) entry[base + std::uint64_t{slice} * count] = ListEntry::make(i, 0);
  } else {
    const unsigned rows = __reduce_max_sync(~0u, count);
    if (index % slice == 0) sliceStart[s] = rows;
  }
}

template <int D>
__device__ inline std::int32_t fixed(const CellGrid<D>& grid, double x, int k) {
  const double turns = (x - grid.origin[k]) / grid.length[k];
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(__double2ull_rn(turns * 4294967296.0)));
}

/// Runs along the list of a particle: add(load(entry)), the loads of four neighbours being on their way together.
template <class Load, class Add>
__device__ inline void alongList(const std::uint64_t* sliceStart, const ListEntry* entry, std::uint32_t i,
                                 Load&& load, Add&& add) {
  constexpr int batch = 4;
  const std::uint64_t begin = sliceStart[i / slice];
  const auto rows = static_cast<int>(sliceStart[i / slice + 1] - begin);
  const ListEntry* mine = entry + begin * slice + i % slice;
  const auto at = [&](int row) { return mine[static_cast<std::size_t>(row) * slice]; };
  int r = 0;
  for (; r + batch <= rows; r += batch) {
    decltype(load(at(0))) loaded[batch];
#pragma unroll
    for (int k = 0; k < batch; ++k) loaded[k] = load(at(r + k));
#pragma unroll
    for (int k = 0; k < batch; ++k) add(loaded[k]);
  }
  for (; r < rows; ++r) add(load(at(r)));
}

/// One thread per fluid particle: y += C q; reads positions and q of the neighbours. No atomics.
template <int D>
__global__ void __launch_bounds__(128)
    addGradientKernel(const __grid_constant__ MphPairs<D> pairs, PairConstants<D, double> constants,
                      const std::uint64_t* sliceStart, const ListEntry* entry, const double* __restrict__ q,
                      Vec<D>* y) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.fluidCount) return;
  const Vec<D>* __restrict__ position = pairs.position.data();
  const Vec<D> xi = position[i];
  const double qi = q[i], h = pairs.pressureWeight.radius, floor = distanceFloor<double> * h * h;
  Vec<D> sum{};
  struct Loaded {
    Vec<D> x;
    double q;
    std::uint32_t image;
  };
  const auto load = [&](ListEntry e) { return Loaded{position[e.index()], q[e.index()], e.image()}; };
  alongList(sliceStart, entry, i, load, [&](const Loaded& other) {
    Vec<D> d = other.x - xi;
    if (other.image != 0) d += pairs.images.shift[other.image];
    double r2 = floor;
    for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
    addScaled(&sum[0], constants.pressureReach(inverseSqrt(r2)) * (qi + other.q), d);
  });
  y[i] += constants.pressureFactor * sum;
}

/// What the single-precision kernels read.
template <int D>
struct SingleView {
  const std::uint64_t* sliceStart;
  const ListEntry* entry;
  Places<D, float> places;
  PairConstants<D, float> constants;
  std::uint32_t fluidCount, activeCount;

  __device__ float reach(const Vec<D, float>& d) const {
    float r2 = places.floor;
    for (int k = 0; k < D; ++k) r2 = fmaf(d[k], d[k], r2);
    return constants.pressureReach(inverseSqrt(r2));
  }
};

/// One thread per fluid particle: y = C q, or y += C q. No atomics.
template <int D, bool Add>
__global__ void __launch_bounds__(128)
    gradientKernel(const __grid_constant__ SingleView<D> v, const float* __restrict__ q, Vec<D, float>* y) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= v.fluidCount) return;
  const int4 xi = v.places.fixed[i];
  const float qi = q[i];
  Vec<D, float> sum{};
  struct Loaded {
    int4 x;
    float q;
  };
  const auto load = [&](ListEntry e) { return Loaded{v.places.fixed[e.index()], q[e.index()]}; };
  alongList(v.sliceStart, v.entry, i, load, [&](const Loaded& other) {
    const Vec<D, float> d = v.places.local(other.x, xi);
    addScaled(&sum[0], v.reach(d) * (qi + other.q), d);
  });
  const Vec<D, float> result = v.constants.pressureFactor * sum;
  y[i] = Add ? y[i] + result : result;
}

/// One thread per particle: div = C^T u. No atomics.
template <int D>
__global__ void __launch_bounds__(128)
    divergenceKernel(const __grid_constant__ SingleView<D> v, const Vec<D, float>* __restrict__ u, float* div) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= v.activeCount) return;
  const int4 xi = v.places.fixed[i];
  const Vec<D, float> ui = i < v.fluidCount ? u[i] : Vec<D, float>{};
  float sum = 0;
  struct Loaded {
    int4 x;
    Vec<D, float> u;
  };
  const auto load = [&](ListEntry e) {
    const std::uint32_t j = e.index();
    return Loaded{v.places.fixed[j], j < v.fluidCount ? u[j] : Vec<D, float>{}};
  };
  alongList(v.sliceStart, v.entry, i, load, [&](const Loaded& other) {
    const Vec<D, float> d = v.places.local(other.x, xi);
    sum = fmaf(v.reach(d), differenceAlong(other.u, ui, d), sum);
  });
  div[i] = -v.constants.pressureFactor * sum;
}

template <int D>
SingleView<D> singleView(const MphPairs<D>& pairs, const Buffer<std::uint64_t, Cuda>& sliceStart,
                         const Buffer<ListEntry, Cuda>& entry, const Buffer<std::int32_t, Cuda>& position) {
  using P = Places<D, float>;
  return {sliceStart.data(),
          entry.data(),
          P::make(pairs, position.data()),
          PairConstants<D, float>::make(pairs, P::unit(pairs)),
          pairs.fluidCount,
          pairs.activeCount};
}

}  // namespace

template <int D>
void NearProducts<D>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs) {
  pairs_ = &pairs;
  const std::uint32_t slices = blocksFor(pairs.activeCount, slice);
  const unsigned blocks = blocksFor(std::size_t{slices} * slice, 128);
  sliceStart_.resize(context, std::size_t{slices} + 1);
  launch(context, blocks, 128, 0, listKernel<D, false>, pairs, sliceStart_.data(), nullptr);
  entry_.resize(context, startRows(context, sliceStart_) * slice);
  launch(context, blocks, 128, 0, listKernel<D, true>, pairs, sliceStart_.data(), entry_.data());

  fixedPosition_.resize(context, std::size_t{4} * pairs.activeCount);
  auto* target = reinterpret_cast<int4*>(fixedPosition_.data());
  const Vec<D>* position = pairs.position.data();
  const CellGrid<D> grid = pairs.grid;
  forEach(context, pairs.activeCount, [=] __device__(std::size_t i) {
    const Vec<D> x = position[i];
    target[i] = {fixed(grid, x[0], 0), fixed(grid, x[1], 1), D == 3 ? fixed(grid, x[D - 1], D - 1) : 0, 0};
  });
}

template <int D>
void NearProducts<D>::addPressureGradient(Context<Cuda>& context, std::span<const double> q,
                                          std::span<Vec<D>> y) const {
  launch(context, blocksFor(pairs_->fluidCount, 128), 128, 0, addGradientKernel<D>, *pairs_,
         PairConstants<D, double>::make(*pairs_, 1), sliceStart_.data(), entry_.data(), q.data(), y.data());
}

template <int D>
void NearProducts<D>::addPressureGradient(Context<Cuda>& context, std::span<const float> q,
                                          std::span<Vec<D, float>> y) const {
  launch(context, blocksFor(pairs_->fluidCount, 128), 128, 0, gradientKernel<D, true>,
         singleView(*pairs_, sliceStart_, entry_, fixedPosition_), q.data(), y.data());
}

template <int D>
void NearProducts<D>::pressureGradient(Context<Cuda>& context, std::span<const float> q,
                                       std::span<Vec<D, float>> y) const {
  launch(context, blocksFor(pairs_->fluidCount, 128), 128, 0, gradientKernel<D, false>,
         singleView(*pairs_, sliceStart_, entry_, fixedPosition_), q.data(), y.data());
}

template <int D>
void NearProducts<D>::divergence(Context<Cuda>& context, std::span<const Vec<D, float>> u,
                                 std::span<float> div) const {
  launch(context, blocksFor(pairs_->activeCount, 128), 128, 0, divergenceKernel<D>,
         singleView(*pairs_, sliceStart_, entry_, fixedPosition_), u.data(), div.data());
}

template class NearProducts<2>;
template class NearProducts<3>;

}  // namespace treacle
