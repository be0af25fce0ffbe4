#pragma once

#include "core/launch.hpp"
#include "method/pair_terms.cuh"
#include "treacle/method/near_products.hpp"
#include "treacle/method/projection_terms.hpp"

namespace treacle {

/// Sums over each particle's own neighbours within h_p (NearProducts has the lists): C q and C^T u, handed to a
/// `store` particle by particle.

/// What the kernels read of the lists and positions in the arithmetic T.
template <int D, class T>
struct NearView;

template <int D>
struct NearView<D, double> {
  using Stored = Vec<D>;
  const std::uint64_t* sliceStart;
  const ListEntry* entry;
  std::uint32_t fluidCount, activeCount;
  PairConstants<D, double> constants;
  double floor;
  const Vec<D>* position;
  PeriodicImages<D> images;

  static NearView make(const MphPairs<D>& pairs, const NearProducts<D>& near) {
    return {near.sliceStart().data(),
            near.entries().data(),
            pairs.fluidCount,
            pairs.activeCount,
            PairConstants<D, double>::make(pairs, 1),
            Places<D, double>::make(pairs).floor,
            pairs.position.data(),
            pairs.images};
  }
  __device__ Stored own(std::uint32_t i) const { return position[i]; }
  __device__ Stored other(ListEntry e) const {
    Vec<D> x = position[e.index()];
    if (e.image() != 0) x += images.shift[e.image()];
    return x;
  }
  __device__ Vec<D> difference(const Stored& a, const Stored& b) const { return a - b; }
};

template <int D>
struct NearView<D, float> {
  using Stored = int4;
  const std::uint64_t* sliceStart;
  const ListEntry* entry;
  std::uint32_t fluidCount, activeCount;
  PairConstants<D, float> constants;
  float floor;
  Places<D, float> places;

  static NearView make(const MphPairs<D>& pairs, const NearProducts<D>& near) {
    const auto places = Places<D, float>::make(pairs, near.fixedPosition().data());
    return {near.sliceStart().data(),
            near.entries().data(),
            pairs.fluidCount,
            pairs.activeCount,
            PairConstants<D, float>::make(pairs, places.unit(pairs)),
            places.floor,
            places};
  }
  __device__ Stored own(std::uint32_t i) const { return places.fixed[i]; }
  __device__ Stored other(ListEntry e) const { return places.fixed[e.index()]; }
  __device__ Vec<D, float> difference(const Stored& a, const Stored& b) const { return places.local(a, b); }
};

/// (1/r - 1/h), zero outside the radius.
template <int D, class T>
__device__ inline T pressureReach(const NearView<D, T>& view, const Vec<D, T>& d) {
  T r2 = view.floor;
  for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
  return view.constants.pressureReach(inverseSqrt(r2));
}

/// One fetch where the type allows it.
template <int D, class T>
__device__ inline Vec<D, T> fetch(const Gathered<D, T>* from) {
  if constexpr (std::is_same_v<T, float> && D == 3) {
    const float4 v = *reinterpret_cast<const float4*>(from);
    return {v.x, v.y, v.z};
  } else if constexpr (std::is_same_v<T, float> && D == 2) {
    const float2 v = *reinterpret_cast<const float2*>(from);
    return {v.x, v.y};
  } else {
    return *from;
  }
}
template <int D, class T>
__device__ inline Vec<D, T> fetch(const Vec<D, T>* from) {
  return *from;
}

/// Runs along the list of a particle, every Split-th entry from `part` on: add(load(entry)), the loads of four
/// neighbours being on their way together.
template <int Split = 1, class Load, class Add>
__device__ inline void alongList(const std::uint64_t* sliceStart, const ListEntry* entry, std::uint32_t i,
                                 Load&& load, Add&& add, int part = 0) {
  constexpr int batch = 4;
  constexpr unsigned slice = nearSlice;
  const std::uint64_t begin = sliceStart[i / slice];
  const auto rows = static_cast<int>(sliceStart[i / slice + 1] - begin);
  const ListEntry* mine = entry + begin * slice + i % slice;
  const auto at = [&](int row) { return mine[static_cast<std::size_t>(row) * slice]; };
  int r = part;
  for (; r + (batch - 1) * Split < rows; r += batch * Split) {
    decltype(load(at(0))) loaded[batch];
#pragma unroll
    for (int k = 0; k < batch; ++k) loaded[k] = load(at(r + k * Split));
#pragma unroll
    for (int k = 0; k < batch; ++k) add(loaded[k]);
  }
  for (; r < rows; r += Split) add(load(at(r)));
}

/// Sum over groups of Split consecutive lanes, in all of them.
template <int Split, class T>
__device__ inline T splitSum(T value) {
  for (int offset = Split / 2; offset > 0; offset /= 2) value += __shfl_xor_sync(~0u, value, offset);
  return value;
}

/// What a product reads of a particle: where it stands and the gathered quantity. `Fields` fetch both at once
/// where they stand side by side.
template <int D, class T>
struct PlacedValue {
  typename NearView<D, T>::Stored x;
  T value;
};
template <int D, class T>
struct PlainScalars {
  const T* q;
  __device__ PlacedValue<D, T> own(const NearView<D, T>& view, std::uint32_t i) const {
    return {view.own(i), q[i]};
  }
  __device__ PlacedValue<D, T> other(const NearView<D, T>& view, ListEntry e) const {
    return {view.other(e), q[e.index()]};
  }
};
template <int D>
struct PlacedScalars {
  const PlacedScalar* at;
  __device__ PlacedValue<D, float> own(const NearView<D, float>&, std::uint32_t i) const {
    const int4 stored = *reinterpret_cast<const int4*>(at + i);
    return {stored, __int_as_float(stored.w)};
  }
  __device__ PlacedValue<D, float> other(const NearView<D, float>& view, ListEntry e) const {
    return own(view, e.index());
  }
};

template <int D, class T>
struct PlacedVelocity {
  typename NearView<D, T>::Stored x;
  Vec<D, T> u;
};
/// Walls have none.
template <int D, class T, class V>
struct PlainVectors {
  const V* u;
  __device__ PlacedVelocity<D, T> own(const NearView<D, T>& view, std::uint32_t k) const {
    return {view.own(k), k < view.fluidCount ? fetch(&u[k]) : Vec<D, T>{}};
  }
  __device__ PlacedVelocity<D, T> other(const NearView<D, T>& view, ListEntry e) const {
    const std::uint32_t j = e.index();
    return {view.other(e), j < view.fluidCount ? fetch(&u[j]) : Vec<D, T>{}};
  }
};
template <int D>
struct PlacedVectors {
  const PlacedVector<D>* at;
  __device__ PlacedVelocity<D, float> own(const NearView<D, float>&, std::uint32_t k) const {
    const int4 stored = *reinterpret_cast<const int4*>(at + k);
    if constexpr (D == 2) {
      return {stored, {__int_as_float(stored.z), __int_as_float(stored.w)}};
    } else {
      // Third position in the numbers' low bits, which are left there: an error of 2^-18.
      constexpr int low = PlacedVector<3>::low;
      const int z = (stored.y & low) << 16 | (stored.z & low) << 22 | stored.w << 28;
      return {{stored.x << 16, stored.x & ~0xffff, z, 0},
              {__int_as_float(stored.y), __int_as_float(stored.z), __int_as_float(stored.w)}};
    }
  }
  __device__ PlacedVelocity<D, float> other(const NearView<D, float>& view, ListEntry e) const {
    return own(view, e.index());
  }
};

/// Split threads per fluid particle: store(i, (C q)_i); reads positions and q of the neighbours. No atomics.
template <int Split, int D, class T, class Scalars, class Store>
__global__ void __launch_bounds__(128) nearGradientKernel(const __grid_constant__ NearView<D, T> view,
                                                          const Scalars q, const __grid_constant__ Store store) {
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / Split;
  if (Split == 1 && own >= view.fluidCount) return;
  const std::uint32_t i = min(own, view.fluidCount - 1);  // all lanes of a warp take part in the sum
  const auto mine = q.own(view, i);
  Vec<D, T> sum{};
  alongList<Split>(
      view.sliceStart, view.entry, i, [&](ListEntry e) { return q.other(view, e); },
      [&](const PlacedValue<D, T>& other) {
        const Vec<D, T> d = view.difference(other.x, mine.x);
        addScaled(&sum[0], pressureReach(view, d) * (mine.value + other.value), d);
      },
      thread % Split);
  for (int k = 0; k < D; ++k) sum[k] = splitSum<Split>(sum[k]);
  if (thread % Split == 0 && own == i) store(i, view.constants.pressureFactor * sum);
}

/// Split threads per particle: store(k, (C^T u)_k), walls at rest; reads positions and u of the neighbours. No
/// atomics.
template <int Split, int D, class T, class Vectors, class Store>
__global__ void __launch_bounds__(128) nearDivergenceKernel(const __grid_constant__ NearView<D, T> view,
                                                            const Vectors u, const __grid_constant__ Store store) {
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / Split;
  if (Split == 1 && own >= view.activeCount) return;
  const std::uint32_t k = min(own, view.activeCount - 1);
  const auto mine = u.own(view, k);
  T sum = 0;
  alongList<Split>(
      view.sliceStart, view.entry, k, [&](ListEntry e) { return u.other(view, e); },
      [&](const PlacedVelocity<D, T>& other) {
        const Vec<D, T> d = view.difference(other.x, mine.x);
        sum = fma(pressureReach(view, d), differenceAlong(other.u, mine.u, d), sum);
      },
      thread % Split);
  sum = splitSum<Split>(sum);
  if (thread % Split == 0 && own == k) store(k, -view.constants.pressureFactor * sum);
}

/// Lanes threads per particle: store(k, (C^T W C q)_k) in one pass; each lane forms W C q of one neighbour after
/// the other from that neighbour's list. Nine (2D) or 23 times (3D) the arithmetic of two passes, and half the
/// launches: pays where those take the time. No atomics.
template <int Lanes, int D, class T, class Scalars, class Store>
__global__ void __launch_bounds__(128)
    nearSchurKernel(const __grid_constant__ NearView<D, T> view, const Scalars q,
                    const __grid_constant__ ProjectionTable<T> table, const std::uint8_t* material,
                    const __grid_constant__ Store store) {
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / Lanes;
  const std::uint32_t k = min(own, view.activeCount - 1);  // all lanes of a warp take part in the sums
  const int lane = static_cast<int>(thread % Lanes);
  const auto velocity = [&](std::uint32_t i) {
    Vec<D, T> sum{};
    if (i >= view.fluidCount) return sum;  // walls are at rest
    const auto mine = q.own(view, i);
    alongList(
        view.sliceStart, view.entry, i, [&](ListEntry e) { return q.other(view, e); },
        [&](const PlacedValue<D, T>& other) {
          const Vec<D, T> d = view.difference(other.x, mine.x);
          addScaled(&sum[0], pressureReach(view, d) * (mine.value + other.value), d);
        });
    return table.weight[material[i]] * sum;
  };
  const auto xk = q.own(view, k).x;
  Vec<D, T> gradient{};  // sum of g, which meets k's own velocity
  T along = 0;
  const std::uint64_t begin = view.sliceStart[k / nearSlice];
  const auto rows = static_cast<int>(view.sliceStart[k / nearSlice + 1] - begin);
  for (int r = lane; r < rows; r += Lanes) {
    const ListEntry e = view.entry[(begin + r) * nearSlice + k % nearSlice];
    const Vec<D, T> d = view.difference(q.other(view, e).x, xk), g = pressureReach(view, d) * d;
    gradient += g;
    if (e.index() != k) along += dot(g, velocity(e.index()));
  }
  // The last lane has the fewest neighbours.
  Vec<D, T> mine = lane == Lanes - 1 ? velocity(k) : Vec<D, T>{};
  along = splitSum<Lanes>(along);
  for (int c = 0; c < D; ++c) {
    gradient[c] = splitSum<Lanes>(gradient[c]);
    mine[c] = __shfl_sync(~0u, mine[c], Lanes - 1, Lanes);
  }
  const T factor = view.constants.pressureFactor;
  if (lane == 0 && own == k) store(k, -factor * factor * (along - dot(gradient, mine)));
}

/// Calls f(Split): small systems leave lanes idle, and wait for the longest list.
template <int D, class F>
void withSplit(std::uint32_t particles, F&& f) {
  constexpr std::uint32_t threads = 1u << 17;  // what a card runs at a time
  if (D == 3 && particles < threads / 4)
    f(std::integral_constant<int, 8>{});
  else if (particles < threads)
    f(std::integral_constant<int, 4>{});
  else
    f(std::integral_constant<int, 1>{});
}

template <int D, class T, class Scalars, class Store>
void nearGradient(const Context<Cuda>& context, const NearView<D, T>& view, const Scalars& q, const Store& store) {
  withSplit<D>(view.fluidCount, [&](auto split) {
    launch(context, blocksFor(std::size_t{view.fluidCount} * split, 128), 128, 0,
           nearGradientKernel<split, D, T, Scalars, Store>, view, q, store);
  });
}
/// Up to so many particles one pass is faster than two.
template <int D>
inline constexpr std::uint32_t onePassParticles = D == 2 ? 4000 : 3000;

template <int D, class T, class Scalars, class Store>
void nearSchur(const Context<Cuda>& context, const NearView<D, T>& view, const Scalars& q,
               const ProjectionTable<T>& table, const std::uint8_t* material, const Store& store) {
  constexpr int lanes = D == 2 ? 16 : 32;
  launch(context, blocksFor(std::size_t{view.activeCount} * lanes, 128), 128, 0,
         nearSchurKernel<lanes, D, T, Scalars, Store>, view, q, table, material, store);
}
template <int D, class T, class Vectors, class Store>
void nearDivergence(const Context<Cuda>& context, const NearView<D, T>& view, const Vectors& u,
                    const Store& store) {
  withSplit<D>(view.activeCount, [&](auto split) {
    launch(context, blocksFor(std::size_t{view.activeCount} * split, 128), 128, 0,
           nearDivergenceKernel<split, D, T, Vectors, Store>, view, u, store);
  });
}

}  // namespace treacle
