#include "treacle/mph/near_products.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "mph/near_sums.cuh"
#include "treacle/mph/mph_sums.hpp"

namespace treacle {
namespace {

constexpr unsigned slice = nearSlice;

/// `split` threads per particle; reads cluster lists and positions. Without Fill leaves the rows of the slices,
/// zero before, with Fill writes their entries. Walls list fluid alone, and ghosts nothing. Atomics for the
/// largest of whole numbers.
template <bool Fill, class Split, int D>
__global__ void __launch_bounds__(128) listKernel(const Split split, const __grid_constant__ MphPairs<D> pairs,
                                                  std::uint64_t* sliceStart, std::uint32_t* entry) {
  const std::uint32_t index = (blockIdx.x * blockDim.x + threadIdx.x) / split, s = index / slice;
  if (s * slice >= pairs.activeCount) return;
  const std::uint32_t i = min(index, pairs.activeCount - 1);
  const bool valid = index < pairs.activeCount, wall = i >= pairs.fluidCount;
  const int part = static_cast<int>(threadIdx.x % split);
  const unsigned team = splitLanes(split);
  const ClusterListView& list = wall ? pairs.wallList : pairs.fluidList;
  const bool own = pairs.isOwn(i);
  const std::uint32_t cluster = own ? (i - list.first) / clusterSize : 0;
  const Vec<D> xi = pairs.position[i];
  const double h2 = pairs.terms.pressureRadius * pairs.terms.pressureRadius;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  constexpr int batch = 4;  // so many neighbours are on their way together
  std::uint32_t count = 0;
  const std::uint64_t base = Fill ? sliceStart[s] * slice + index % slice : 0;
  for (const ListSegment segment : {ListSegment::NearFluid, ListSegment::NearWall}) {
    const std::uint64_t begin = offset[static_cast<int>(segment)],
                        end = !own || (wall && segment == ListSegment::NearWall)
                                  ? begin
                                  : offset[static_cast<int>(segment) + 1];
    for (std::uint64_t k = begin + part; __any_sync(~0u, k < end); k += batch * split) {
      std::uint32_t j[batch];
      Vec<D> x[batch];
#pragma unroll
      for (int b = 0; b < batch; ++b) j[b] = k + b * split < end ? list.entry[k + b * split] : i;
#pragma unroll
      for (int b = 0; b < batch; ++b) x[b] = pairs.position[j[b]];
#pragma unroll
      for (int b = 0; b < batch; ++b) {
        const bool near = j[b] != i && norm2(pairs.grid.difference(xi, x[b])) < h2 && !pairs.areParted(i, j[b]);
        const unsigned all = __ballot_sync(~0u, near) & team;
        if (Fill && near && valid)
          entry[base + std::uint64_t{slice} * (count + __popc(all & ((1u << threadIdx.x % 32) - 1)))] = j[b];
        count += __popc(all);
      }
    }
  }
  if (Fill) {
    const auto rows = static_cast<std::uint32_t>(sliceStart[s + 1] - sliceStart[s]);
    for (count += part; valid && count < rows; count += split) entry[base + std::uint64_t{slice} * count] = i;
  } else {
    unsigned rows = count;
    for (int offset = 16; offset > 0; offset /= 2) rows = max(rows, __shfl_xor_sync(~0u, rows, offset));
    if (threadIdx.x % 32 == 0) atomicMax(reinterpret_cast<unsigned long long*>(&sliceStart[s]), rows);
  }
}

template <int D>
__device__ inline std::int32_t fixed(const CellGrid<D>& grid, double x, int k) {
  const double turns = (x - grid.origin[k]) / grid.length[k];
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(__double2ull_rn(turns * 4294967296.0)));
}

}  // namespace

template <int D>
void NearProducts<D>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs) {
  pairs_ = &pairs;
  const std::uint32_t slices = blocksFor(pairs.activeCount, slice);
  sliceStart_.resize(context, std::size_t{slices} + 1);
  clearBytes(context, sliceStart_.data(), sliceStart_.bytes());
  withSplit<D>(pairs.fluidCount, [&](auto split) {
    using Split = decltype(split);
    const unsigned blocks = blocksFor(std::size_t{slices} * slice * split, 128);
    launch(context, blocks, 128, 0, listKernel<false, Split, D>, split, pairs, sliceStart_.data(), nullptr);
    entry_.resize(context, startRows(context, sliceStart_) * slice);
    launch(context, blocks, 128, 0, listKernel<true, Split, D>, split, pairs, sliceStart_.data(), entry_.data());
  });

  fixedPosition_.resize(context, std::size_t{4} * pairs.activeCount);
  auto* target = reinterpret_cast<int4*>(fixedPosition_.data());
  forEach(context, pairs.activeCount, [=] __device__(std::size_t i) {
    const Vec<D> x = pairs.position[i];
    const auto scale = static_cast<float>(pairs.viscousSide(static_cast<std::uint32_t>(i)).scale);
    target[i] = {fixed(pairs.grid, x[0], 0), fixed(pairs.grid, x[1], 1),
                 D == 3 ? fixed(pairs.grid, x[D - 1], D - 1) : 0, __float_as_int(scale)};
  });
}

template <int D>
void NearProducts<D>::addPressureGradient(Context<Cuda>& context, std::span<const double> q,
                                          std::span<Vec<D>> y) const {
  const auto add = [y = y.data()] __device__(std::uint32_t i, const Vec<D>& gradient) { y[i] += gradient; };
  using Scalars = PlainScalars<D, double>;
  const Scalars scalars{q.data()};
  const Renormalised<D> b{pairs_->renormalisation, pairs_->fluidCount};
  withSchemeTerms(*pairs_, [&]<class Scheme>(const MphTerms<D, double, Scheme>& terms, auto renormalised) {
    const auto view = NearView<D, double, Scheme>::make(*pairs_, *this, terms);
    if constexpr (renormalised)
      nearGradient(context, view, Stresses<D, double, Scalars, Renormalised<D>>{scalars, b}, add);
    else
      nearGradient(context, view, scalars, add);
  });
  subtractGradientAlongWalls<D>(context, *pairs_, q, 1.0, y);
}

template <int D>
void NearProducts<D>::bulkStress(Context<Cuda>& context, std::span<const Vec<D>> u, std::span<double> q) const {
  const PlainVectors<D, double, Vec<D>> vectors{u.data()};
  const Renormalised<D> b{pairs_->renormalisation, pairs_->fluidCount};
  const auto store = [q = q.data(), material = pairs_->material.data(), materials = pairs_->materials,
                      share = pairs_->bulkShare()] __device__(std::uint32_t k, double divergence) {
    q[k] = share.of(k) * materials.bulkViscosity[material[k]] * divergence;
  };
  const auto terms = pairs_->terms.with(AccurateScheme{});
  nearDivergence(context, NearView<D, double, AccurateScheme>::make(*pairs_, *this, terms), vectors, b, store);
  subtractBulkStressAlongWalls<D>(context, *pairs_, u, q);
}

template class NearProducts<2>;
template class NearProducts<3>;

}  // namespace treacle
