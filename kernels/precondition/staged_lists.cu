#include "treacle/precondition/staged_lists.hpp"

#include "core/launch.hpp"
#include "precondition/coarse_positions.cuh"
#include "precondition/placed_sums.cuh"

namespace treacle {
namespace {

constexpr unsigned slice = nearSlice;
constexpr std::uint32_t nobody = 0xffffffff;

/// What of NearProducts and positions is read.
template <int D>
struct NearRows {
  NearLists<D, float> lists;
  const PlacedScalar* places;
  float reach2;  // in the lists' unit

  __device__ int4 place(std::uint32_t i) const {
    return PlacedScalars<D>::place(reinterpret_cast<const int4*>(places)[i]);
  }
};
struct StagedRows {
  std::uint32_t *member, *memberCount, *quads;
  std::uint64_t* entry;
};

/// f(j, its place) for the neighbours of particle i within reach, in the order of its row.
template <int D, class F>
__device__ inline void forEachNeighbour(const NearRows<D>& near, std::uint32_t i, const int4& own, F&& f) {
  constexpr int batch = 4;  // so many neighbours are on their way together
  const std::uint64_t begin = near.lists.sliceStart[i / slice];
  const auto rows = static_cast<int>(near.lists.sliceStart[i / slice + 1] - begin);
  const std::uint32_t* mine = near.lists.entry + begin * slice + i % slice;
  for (int r = 0; r < rows; r += batch) {
    std::uint32_t j[batch];
    int4 there[batch];
#pragma unroll
    for (int b = 0; b < batch; ++b) j[b] = r + b < rows ? mine[std::size_t{slice} * (r + b)] : i;
#pragma unroll
    for (int b = 0; b < batch; ++b) there[b] = near.place(j[b]);
#pragma unroll
    for (int b = 0; b < batch; ++b)
      if (j[b] != i && norm2(near.lists.difference(there[b], own)) < near.reach2) f(j[b], there[b]);
  }
}

/// Who a block needs, in shared memory: while they are collected an open hash table, then in ascending order, so
/// that those who follow each other are fetched together.
template <std::uint32_t Capacity>
struct MemberTable {
  static constexpr std::uint32_t slots = Capacity <= 512 ? 1024 : 2048;
  std::uint32_t key[slots];
  std::uint32_t count, torn;

  __device__ static std::uint32_t read(const std::uint32_t& x) {
    return *static_cast<const volatile std::uint32_t*>(&x);
  }
  __device__ void clear() {
    for (unsigned s = threadIdx.x; s < slots; s += blockDim.x) key[s] = nobody;
    if (threadIdx.x == 0) count = torn = 0;
    __syncthreads();
  }
  __device__ void insert(std::uint32_t k) {
    for (std::uint32_t s = k * 2654435761u >> 16; !read(torn); ++s) {
      std::uint32_t there = read(key[s % slots]);  // most are there already
      if (there == nobody) {
        there = atomicCAS(&key[s % slots], nobody, k);
        if (there == nobody && atomicAdd(&count, 1) >= Capacity) torn = 1;
      }
      if (there == nobody || there == k) return;
    }
  }
  /// By a bitonic network; the empty slots come last.
  __device__ void sort() {
    for (std::uint32_t run = 2; run <= slots; run *= 2)
      for (std::uint32_t step = run / 2; step > 0; step /= 2) {
        for (std::uint32_t n = threadIdx.x; n < slots / 2; n += blockDim.x) {
          const std::uint32_t a = n / step * 2 * step + n % step, b = a + step;
          const std::uint32_t first = key[a], second = key[b];
          if ((first > second) == ((a & run) == 0)) key[a] = second, key[b] = first;
        }
        __syncthreads();
      }
  }
  /// Among the sorted.
  __device__ std::uint32_t placeOf(std::uint32_t k) const {
    std::uint32_t place = 0;
    for (std::uint32_t step = slots / 2; step > 0; step /= 2)
      if (key[place + step] <= k) place += step;
    return place;
  }
};

/// Whether the difference of two places is the difference of what they are from a block's origin, which 32 bits
/// must hold on all axes: else the block reaches around the multiples of a length that places leave out.
template <int D>
__device__ inline bool seenAlike(const int4& origin, const int4& i, const int4& j) {
  const auto overflows = [](int o, int a, int b) {
    const unsigned fromI = static_cast<unsigned>(a) - static_cast<unsigned>(o),
                   fromJ = static_cast<unsigned>(b) - static_cast<unsigned>(o);
    return (fromI ^ fromJ) & (fromJ ^ (fromJ - fromI));
  };
  const unsigned any = overflows(origin.x, i.x, j.x) | overflows(origin.y, i.y, j.y) |
                       (D == 3 ? overflows(origin.z, i.z, j.z) : 0u);
  return any >> 31 == 0;
}

/// A block of threads per block of Particles, one thread for each of them; reads the rows of NearProducts and
/// positions, writes the block's members and the rows of its slices. Atomics in shared memory, on which the result
/// does not depend.
template <int D, unsigned Particles, std::uint32_t Capacity>
__global__ void __launch_bounds__(StagedLists<D>::threads)
    stageKernel(const __grid_constant__ NearRows<D> near, const StagedRows out) {
  __shared__ MemberTable<Capacity> table;
  table.clear();
  const std::uint32_t active = near.lists.activeCount, index = blockIdx.x * Particles + threadIdx.x,
                      i = min(index, active - 1);
  const bool taken = threadIdx.x < Particles;
  const int4 origin = near.place(StagedView::origin(blockIdx.x, Particles, active)), own = near.place(i);
  std::uint32_t count = 0;
  if (taken) {
    table.insert(i);
    forEachNeighbour(near, i, own, [&](std::uint32_t j, const int4& there) {
      table.insert(j);
      if (!seenAlike<D>(origin, own, there)) table.torn = 1;
      ++count;
    });
  }
  __syncthreads();
  if (threadIdx.x == 0) out.memberCount[blockIdx.x] = table.torn ? StagedView::torn : table.count;
  if (table.torn) return;
  table.sort();
  for (unsigned k = threadIdx.x; k < table.count; k += blockDim.x)
    out.member[std::size_t{Capacity} * blockIdx.x + k] = table.key[k];

  const std::uint32_t quads = __reduce_max_sync(~0u, (count + 3) / 4), s = index / slice;
  if (!taken || s * slice >= active) return;
  if (index % slice == 0) out.quads[s] = quads;
  std::uint64_t* row = out.entry + StagedView::start(near.lists.sliceStart[s], s) * slice + index % slice;
  std::uint64_t four = 0;
  std::uint32_t n = 0;
  const auto add = [&](std::uint32_t place) {
    four |= std::uint64_t{16} * place << 16 * (n % 4);
    if (++n % 4 != 0) return;
    row[std::size_t{slice} * (n / 4 - 1)] = four;
    four = 0;
  };
  forEachNeighbour(near, i, own, [&](std::uint32_t j, const int4&) { add(table.placeOf(j)); });
  const std::uint32_t self = table.placeOf(i);
  while (n < 4 * quads) add(self);
}

}  // namespace

template <int D>
void StagedLists<D>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                             const PlacedScalar* places, double reach) {
  sharing_ = sharing(pairs.fluidCount);
  const double length = reach * pairs.terms.pressureRadius, inUnits = length / pairs.terms.viscosityRadius;
  reach2_ = static_cast<float>(inUnits * inUnits);
  const std::uint32_t slices = blocksFor(pairs.activeCount, slice);
  const unsigned blocks = blocksFor(pairs.activeCount, threads / sharing_);
  member_.resize(context, std::size_t{capacity(sharing_)} * blocks);
  memberCount_.resize(context, blocks);
  quads_.resize(context, slices);
  entry_.resize(context, (StagedView::start(near.entries().size() / slice, slices) + 1) * slice);
  const NearRows<D> rows{CoarsePositions<D>::listsOf(pairs, near), places, reach2_};
  const StagedRows out{member_.data(), memberCount_.data(), quads_.data(), entry_.data()};
  const auto start = [&](auto kernel) { launch(context, blocks, threads, 0, kernel, rows, out); };
  if (sharing_ == 1)
    start(stageKernel<D, threads, capacity(1)>);
  else if (sharing_ == 4)
    start(stageKernel<D, threads / 4, capacity(4)>);
  else
    start(stageKernel<D, threads / 8, capacity(8)>);
}

template class StagedLists<2>;
template class StagedLists<3>;

}  // namespace treacle
