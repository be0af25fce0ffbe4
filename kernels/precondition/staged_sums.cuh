#pragma once

#include "mph/near_sums.cuh"
#include "precondition/placed_sums.cuh"
#include "treacle/precondition/staged_lists.hpp"

namespace treacle {

/// C q and C^T u with B, in single precision, from neighbours that a block brings to shared memory (StagedLists).

/// Where a block's neighbours are, from the particle in its middle, in what takes the place of their positions: in
/// two dimensions as lengths, in three as 16 bits, half of their range added, which become numbers among the low
/// bits of 2^23. difference() gives lengths.
template <int D>
struct BlockPlaces;

template <>
struct BlockPlaces<2> {
  using Place = Vec<2, float>;
  int origin[2];
  Place unit;

  __device__ BlockPlaces(const LocalPositions<2, float>& places, const PlacedScalar& first)
      : origin{static_cast<int>(first.word[0]), static_cast<int>(first.word[1])}, unit(places.scale) {}

  __device__ int4 scalar(const int4& p) const {
    // Rounded here: fused into a later subtraction, a particle would not be at distance zero from itself.
    const auto length = [&](int x, int k) {
      const auto steps = static_cast<int>(static_cast<unsigned>(x) - static_cast<unsigned>(origin[k]));
      return __float_as_int(__fmul_rn(static_cast<float>(steps), unit[k]));
    };
    return {length(p.x, 0), length(p.y, 1), p.z, p.w};
  }
  __device__ int4 vector(const int4& p) const { return scalar(p); }
  __device__ static Place ofScalar(const int4& p) { return {__int_as_float(p.x), __int_as_float(p.y)}; }
  __device__ static Place ofVector(const int4& p) { return ofScalar(p); }
  __device__ Vec<2, float> difference(const Place& a, const Place& b) const { return a - b; }
};

template <>
struct BlockPlaces<3> {
  using Place = Vec<3, float>;
  static constexpr unsigned half = 0x8000, magic = 0x4b000000, low = PlacedVector<3>::low;
  unsigned originXy, originZ;
  Vec<3, float> unit;

  __device__ BlockPlaces(const LocalPositions<3, float>& places, const PlacedScalar& first)
      : originXy(first.word[0]), originZ(first.word[1]), unit(65536.f * places.scale) {}

  __device__ int4 scalar(const int4& p) const {
    return {xy(p.x), static_cast<int>((static_cast<unsigned>(p.y) & 0xffff0000) | z(static_cast<unsigned>(p.y))),
            p.z, p.w};
  }
  __device__ int4 vector(const int4& p) const {
    const unsigned there = z(zOf(p));
    const auto with = [](int word, unsigned bits) {
      return static_cast<int>((static_cast<unsigned>(word) & ~low) | (bits & low));
    };
    return {xy(p.x), with(p.y, there), with(p.z, there >> 6), with(p.w, there >> 12)};
  }
  __device__ static Place ofScalar(const int4& p) { return {number<0>(p.x), number<1>(p.x), number<0>(p.y)}; }
  __device__ static Place ofVector(const int4& p) {
    return {number<0>(p.x), number<1>(p.x), __uint_as_float(zOf(p) | magic)};
  }
  __device__ Vec<3, float> difference(const Place& a, const Place& b) const {
    Vec<3, float> d;
    for (int k = 0; k < 3; ++k) d[k] = __fmul_rn(a[k] - b[k], unit[k]);
    return d;
  }

 private:
  __device__ int xy(int p) const {
    return static_cast<int>(__vsub2(static_cast<unsigned>(p), originXy) ^ (half << 16 | half));
  }
  __device__ unsigned z(unsigned p) const { return ((p - originZ) & 0xffff) ^ half; }
  __device__ static unsigned zOf(const int4& vector) {
    return (vector.y & low) | (vector.z & low) << 6 | (vector.w & 15) << 12;
  }
  template <int Half>
  __device__ static float number(int word) {
    return __uint_as_float(__byte_perm(static_cast<unsigned>(word), magic, Half == 0 ? 0x7610 : 0x7632));
  }
};

/// What the sums read.
template <int D, class Weights>
struct StagedSums {
  NearView<D, float, Weights> near;
  StagedView lists;
  const PlacedScalar* scalars;  // any of the fields, for positions
};

/// Brings what `from` holds of a block's neighbours to shared memory; false: the block is torn.
template <int D, unsigned Capacity, bool Vectors, class Weights>
__device__ inline bool stage(const StagedSums<D, Weights>& sums, const BlockPlaces<D>& places, const void* from,
                             int4* staged) {
  constexpr unsigned threads = StagedLists<D>::threads, batch = 4;
  const std::uint32_t count = sums.lists.memberCount[blockIdx.x];
  if (count == StagedView::torn) return false;
  const std::uint32_t* member = sums.lists.member + std::size_t{Capacity} * blockIdx.x;
  for (unsigned first = threadIdx.x; first < count; first += batch * threads) {
    int4 p[batch];
#pragma unroll
    for (unsigned k = 0; k < batch; ++k)
      p[k] = static_cast<const int4*>(from)[member[min(first + k * threads, count - 1)]];
#pragma unroll
    for (unsigned k = 0; k < batch; ++k)
      if (first + k * threads < count)
        staged[first + k * threads] = Vectors ? places.vector(p[k]) : places.scalar(p[k]);
  }
  __syncthreads();
  return true;
}

/// add(what is staged of a neighbour) for the neighbours of particle i, `part` of those who share its row.
template <class Add, class Split>
__device__ inline void alongStagedRow(const StagedView& lists, const int4* staged, std::uint32_t i, int part,
                                      Split split, Add&& add) {
  constexpr unsigned slice = nearSlice;
  const std::uint32_t s = i / slice;
  const std::uint64_t* row = lists.entry + StagedView::start(lists.sliceStart[s], s) * slice + i % slice;
  const auto quads = static_cast<int>(lists.quads[s]);
  const auto at = [&](std::uint32_t bytes) {
    return *reinterpret_cast<const int4*>(reinterpret_cast<const char*>(staged) + bytes);
  };
  std::uint64_t four = part < quads ? row[std::size_t{slice} * part] : 0;
#pragma unroll 1
  for (int q = part; q < quads; q += split) {
    const auto a = static_cast<std::uint32_t>(four), b = static_cast<std::uint32_t>(four >> 32);
    const int4 other[4] = {at(a & 0xffff), at(a >> 16), at(b & 0xffff), at(b >> 16)};
    if (q + split < quads) four = row[std::size_t{slice} * (q + split)];
#pragma unroll
    for (int k = 0; k < 4; ++k) add(other[k]);
  }
}

/// -w'/r of a pair that the rows of NearProducts hold; zero beyond the reach of the staged ones.
template <int D, class Weights>
__device__ inline float shapeWithinReach(const StagedSums<D, Weights>& sums, const Vec<D, float>& d) {
  return norm2(d) < sums.lists.reach2 ? gradientShape(sums.near, d) : 0.f;
}

/// sum += g q B d for a neighbour's pressure q and its B.
template <int D>
__device__ inline void addStress(Vec<D, float>& sum, float g, const int4& other, const Vec<D, float>& d) {
  addScaled(&sum[0], g * (__int_as_float(other.w) * (1.f / PackedTensor<D>::scale)), unpack<D>(other) * d);
}

/// `split` threads per fluid particle: store(i, (C q)_i); reads positions and q of the neighbours. No atomics.
template <class Split, int D, class Weights, class Store>
__global__ void __launch_bounds__(256)
    stagedGradientKernel(const Split split, const __grid_constant__ StagedSums<D, Weights> sums,
                         const PlacedScalar* q, const __grid_constant__ Store store) {
  extern __shared__ int4 staged[];
  constexpr unsigned particles = StagedLists<D>::threads / Split::value;
  waitForEarlierKernels();
  const BlockPlaces<D> places(sums.near.places,
                              sums.scalars[StagedView::origin(blockIdx.x, particles, sums.near.activeCount)]);
  const bool whole = stage<D, StagedLists<D>::capacity(Split::value), false>(sums, places, q, staged);
  const std::uint32_t own = blockIdx.x * particles + threadIdx.x / split;
  const int part = static_cast<int>(threadIdx.x % split);
  if (split == 1 && own >= sums.near.fluidCount) return;
  const std::uint32_t i = min(own, sums.near.fluidCount - 1);  // all lanes of a warp take part in the sum
  const int4 mine = reinterpret_cast<const int4*>(q)[i];
  decltype(ownOf(store, i)) owned{};  // where threads are few; many hide the wait, and want registers
  if constexpr (Split::value > 1) owned = ownOf(store, i);
  Vec<D, float> sum{}, gradient{};
  const auto add = [&](float g, const int4& other, const Vec<D, float>& d) {
    addStress(sum, g, other, d);
    addScaled(&gradient[0], g, d);
  };
  if (whole) {
    const auto at = BlockPlaces<D>::ofScalar(places.scalar(mine));
    alongStagedRow(sums.lists, staged, i, part, split, [&](const int4& other) {
      const Vec<D, float> d = places.difference(BlockPlaces<D>::ofScalar(other), at);
      add(gradientShape(sums.near, d), other, d);
    });
  } else {
    const auto at = PlacedScalars<D>::place(mine);
    alongList(
        sums.near.sliceStart, sums.near.entry, i,
        [&](std::uint32_t j) { return reinterpret_cast<const int4*>(q)[j]; },
        [&](const int4& other) {
          const Vec<D, float> d = sums.near.difference(PlacedScalars<D>::place(other), at);
          add(shapeWithinReach(sums, d), other, d);
        },
        part, split);
  }
  addStress(sum, 1.f, mine, gradient);  // the own one meets the sum of g d
  for (int k = 0; k < D; ++k) sum[k] = splitSum(sum[k], split);
  if (part != 0 || own != i) return;
  if constexpr (Split::value == 1) owned = ownOf(store, i);
  put(store, i, sums.near.mph.gradientFactor * sum, owned);
}

/// `split` threads per particle: store(k, (C^T u)_k), walls at rest; reads positions and u of the neighbours. No
/// atomics.
template <class Split, int D, class Weights, class Columns, class Store>
__global__ void __launch_bounds__(256)
    stagedDivergenceKernel(const Split split, const __grid_constant__ StagedSums<D, Weights> sums,
                           const PlacedVector<D>* u, const Columns columns, const __grid_constant__ Store store) {
  extern __shared__ int4 staged[];
  constexpr unsigned particles = StagedLists<D>::threads / Split::value;
  waitForEarlierKernels();
  const BlockPlaces<D> places(sums.near.places,
                              sums.scalars[StagedView::origin(blockIdx.x, particles, sums.near.activeCount)]);
  const bool whole = stage<D, StagedLists<D>::capacity(Split::value), true>(sums, places, u, staged);
  const std::uint32_t own = blockIdx.x * particles + threadIdx.x / split;
  const int part = static_cast<int>(threadIdx.x % split);
  if (split == 1 && own >= sums.near.activeCount) return;
  const std::uint32_t k = min(own, sums.near.activeCount - 1);
  const int4 mine = reinterpret_cast<const int4*>(u)[k];
  const auto b = columns.of(k);
  decltype(ownOf(store, k)) owned{};
  if constexpr (Split::value > 1) owned = ownOf(store, k);
  const Vec<D, float> uk = PlacedVectors<D>::value(mine);
  float sum = 0;
  const auto add = [&](float g, const int4& other, const Vec<D, float>& d) {
    sum = fmaf(g, differenceAlong(PlacedVectors<D>::value(other), uk, b * d), sum);
  };
  if (whole) {
    const auto at = BlockPlaces<D>::ofVector(places.vector(mine));
    alongStagedRow(sums.lists, staged, k, part, split, [&](const int4& other) {
      const Vec<D, float> d = places.difference(BlockPlaces<D>::ofVector(other), at);
      add(gradientShape(sums.near, d), other, d);
    });
  } else {
    const auto at = PlacedVectors<D>::place(mine);
    alongList(
        sums.near.sliceStart, sums.near.entry, k,
        [&](std::uint32_t j) { return reinterpret_cast<const int4*>(u)[j]; },
        [&](const int4& other) {
          const Vec<D, float> d = sums.near.difference(PlacedVectors<D>::place(other), at);
          add(shapeWithinReach(sums, d), other, d);
        },
        part, split);
  }
  sum = splitSum(sum, split);
  if (part != 0 || own != k) return;
  if constexpr (Split::value == 1) owned = ownOf(store, k);
  put(store, k, -sums.near.mph.gradientFactor * sum, owned);
}

/// Calls f(split) with how many threads share a row.
template <int D, class F>
void withSharing(const StagedLists<D>& lists, F&& f) {
  if (lists.sharing() == 8) {
    if constexpr (D == 3) f(Threads<8>{});
  } else if (lists.sharing() == 4) {
    f(Threads<4>{});
  } else {
    f(Threads<1>{});
  }
}

template <int D, class Weights, class Store>
void stagedGradient(const Context<Cuda>& context, const StagedLists<D>& lists, const StagedSums<D, Weights>& sums,
                    const PlacedScalar* q, const Store& store) {
  withSharing(lists, [&](auto split) {
    using L = StagedLists<D>;
    launchEarly(context, blocksFor(std::size_t{sums.near.fluidCount} * split, L::threads), L::threads,
                L::sharedBytes(split), stagedGradientKernel<decltype(split), D, Weights, Store>, split, sums, q,
                store);
  });
}
template <int D, class Weights, class Columns, class Store>
void stagedDivergence(const Context<Cuda>& context, const StagedLists<D>& lists,
                      const StagedSums<D, Weights>& sums, const PlacedVector<D>* u, const Columns& columns,
                      const Store& store) {
  withSharing(lists, [&](auto split) {
    using L = StagedLists<D>;
    launchEarly(context, blocksFor(std::size_t{sums.near.activeCount} * split, L::threads), L::threads,
                L::sharedBytes(split), stagedDivergenceKernel<decltype(split), D, Weights, Columns, Store>, split,
                sums, u, columns, store);
  });
}

}  // namespace treacle
