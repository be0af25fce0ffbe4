#pragma once

#include "mph/near_sums.cuh"
#include "treacle/precondition/projection_terms.hpp"

namespace treacle {

/// Position of 16 bits per axis.
__device__ inline int4 position16(int xy, int z) { return {xy << 16, xy & ~0xffff, z << 16, 0}; }

/// Fields that stand beside the position, one fetch for both.
template <int D>
struct PlacedScalars {
  const PlacedScalar* at;
  __device__ static int4 place(const int4& stored) { return D == 2 ? stored : position16(stored.x, stored.y); }
  __device__ PlacedValue<D, float> own(const NearLists<D, float>&, std::uint32_t i) const {
    const int4 stored = *reinterpret_cast<const int4*>(at + i);
    return {place(stored), __int_as_float(stored.w)};
  }
  __device__ PlacedValue<D, float> other(const NearLists<D, float>& lists, std::uint32_t j) const {
    return own(lists, j);
  }
};

template <int D>
struct PlacedVectors {
  const PlacedVector<D>* at;

  __device__ static int4 place(const int4& stored) {
    if constexpr (D == 2) {
      return stored;
    } else {
      // Third position in the numbers' low bits.
      constexpr int low = PlacedVector<3>::low;
      const int z = (stored.y & low) << 16 | (stored.z & low) << 22 | stored.w << 28;
      return {stored.x << 16, stored.x & ~0xffff, z, 0};
    }
  }
  /// In three dimensions with the position's bits among the low ones, which are left there: an error of 2^-18.
  __device__ static Vec<D, float> value(const int4& stored) {
    if constexpr (D == 2)
      return {__int_as_float(stored.z), __int_as_float(stored.w)};
    else
      return {__int_as_float(stored.y), __int_as_float(stored.z), __int_as_float(stored.w)};
  }
  __device__ PlacedVelocity<D, float> own(const NearLists<D, float>&, std::uint32_t k) const {
    const int4 stored = *reinterpret_cast<const int4*>(at + k);
    return {place(stored), value(stored)};
  }
  __device__ PlacedVelocity<D, float> other(const NearLists<D, float>& lists, std::uint32_t j) const {
    return own(lists, j);
  }
};

/// Lanes threads per particle: store(k, (C^T W C q)_k) in one pass; each lane forms W C q of one neighbour after
/// the other from that neighbour's list. Nine (2D) or 23 times (3D) the arithmetic of two passes, and half the
/// launches: pays where those take the time. No atomics.
template <int Lanes, int D, class T, class Scheme, class Scalars, class Store>
__global__ void __launch_bounds__(128)
    nearSchurKernel(const __grid_constant__ NearView<D, T, Scheme> view, const Scalars q,
                    const __grid_constant__ ProjectionTable<T> table, const std::uint8_t* material,
                    const __grid_constant__ Store store) {
  waitForEarlierKernels();
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / Lanes;
  const std::uint32_t k = min(own, view.activeCount - 1);  // all lanes of a warp take part in the sums
  const int lane = static_cast<int>(thread % Lanes);
  const auto velocity = [&](std::uint32_t i) {
    Vec<D, T> sum{};
    if (i >= view.fluidCount) return sum;  // walls are at rest
    const auto mine = q.own(view, i);
    alongList(
        view.sliceStart, view.entry, i, [&](std::uint32_t j) { return q.other(view, j); },
        [&](const PlacedValue<D, T>& other) {
          const Vec<D, T> d = view.difference(other.x, mine.x);
          addScaled(&sum[0], gradientShape(view, d) * (mine.value + other.value), d);
        });
    return table.weight[material[i]] * sum;
  };
  const auto xk = q.own(view, k).x;
  const auto owned = ownOf(store, k);
  Vec<D, T> gradient{};  // sum of g, which meets k's own velocity
  T along = 0;
  const std::uint64_t begin = view.sliceStart[k / nearSlice];
  const auto rows = static_cast<int>(view.sliceStart[k / nearSlice + 1] - begin);
  for (int r = lane; r < rows; r += Lanes) {
    const std::uint32_t j = view.entry[(begin + r) * nearSlice + k % nearSlice];
    const Vec<D, T> d = view.difference(q.other(view, j).x, xk), g = gradientShape(view, d) * d;
    gradient += g;
    if (j != k) along += dot(g, velocity(j));
  }
  // The last lane has the fewest neighbours.
  Vec<D, T> mine = lane == Lanes - 1 ? velocity(k) : Vec<D, T>{};
  along = splitSum(along, Lanes);
  for (int c = 0; c < D; ++c) {
    gradient[c] = splitSum(gradient[c], Lanes);
    mine[c] = __shfl_sync(~0u, mine[c], Lanes - 1, Lanes);
  }
  const T factor = view.mph.gradientFactor;
  if (lane == 0 && own == k) put(store, k, -factor * factor * (along - dot(gradient, mine)), owned);
}

/// Up to so many particles one pass is faster than two.
template <int D>
inline constexpr std::uint32_t onePassParticles = D == 2 ? 4000 : 3000;

template <int D, class T, class Scheme, class Scalars, class Store>
void nearSchur(const Context<Cuda>& context, const NearView<D, T, Scheme>& view, const Scalars& q,
               const ProjectionTable<T>& table, const std::uint8_t* material, const Store& store) {
  constexpr int lanes = D == 2 ? 16 : 32;
  launchEarly(context, blocksFor(std::size_t{view.activeCount} * lanes, 128), 128, 0,
              nearSchurKernel<lanes, D, T, Scheme, Scalars, Store>, view, q, table, material, store);
}
}  // namespace treacle
