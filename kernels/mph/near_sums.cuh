#pragma once

#include "core/launch.hpp"
#include "mph/product_terms.cuh"
#include "treacle/mph/near_products.hpp"

namespace treacle {

/// Sums over each particle's own neighbours within h_p (NearProducts has the lists): C q and C^T u, handed to a
/// `store` particle by particle. Ghosts have no neighbours, and their C^T u, which nobody reads, is zero.

/// What the kernels read of the lists and positions in the arithmetic T.
template <int D, class T>
struct NearLists;

template <int D>
struct NearLists<D, double> {
  struct Stored {
    Vec<D> x;
    bool wraps;  // of a list's own particle: neighbours may be nearer across a periodic end
  };
  const std::uint64_t* sliceStart;
  const std::uint32_t* entry;
  std::uint32_t ownFluid, fluidCount, activeCount;
  double floor;
  const Vec<D>* position;
  CellGrid<D> grid;
  double reach;  // h_p

  static NearLists make(const MphPairs<D>& pairs, const NearProducts<D>& near) {
    return {near.sliceStart().data(),  near.entries().data(),
            pairs.ownFluid(),          pairs.fluidCount,
            pairs.activeCount,         LocalPositions<D, double>::make(pairs).floor,
            pairs.position.data(),     pairs.grid,
            pairs.terms.pressureRadius};
  }
  __device__ Stored own(std::uint32_t i) const {
    const Vec<D> x = position[i];
    bool wraps = false;
    for (int k = 0; k < D; ++k) {
      const double above = x[k] - grid.origin[k];
      wraps = wraps || (grid.periodic[k] && (above <= reach || grid.length[k] - above <= reach));
    }
    return {x, wraps};
  }
  __device__ Stored other(std::uint32_t j) const { return {position[j], false}; }
  /// From the list's own particle to another.
  __device__ Vec<D> difference(const Stored& other, const Stored& own) const {
    const Vec<D> d = other.x - own.x;
    return own.wraps ? grid.nearest(d) : d;
  }
};

template <int D>
struct NearLists<D, float> {
  using Stored = int4;
  const std::uint64_t* sliceStart;
  const std::uint32_t* entry;
  std::uint32_t ownFluid, fluidCount, activeCount;
  float floor;
  LocalPositions<D, float> places;

  static NearLists make(const MphPairs<D>& pairs, const NearProducts<D>& near) {
    const auto places = LocalPositions<D, float>::make(pairs, near.fixedPosition().data());
    return {near.sliceStart().data(),
            near.entries().data(),
            pairs.ownFluid(),
            pairs.fluidCount,
            pairs.activeCount,
            places.floor,
            places};
  }
  __device__ Stored own(std::uint32_t i) const { return places.fixed[i]; }
  __device__ Stored other(std::uint32_t j) const { return places.fixed[j]; }
  __device__ Vec<D, float> difference(const Stored& other, const Stored& own) const {
    return places.local(other, own);
  }
};

/// The same with the terms of the pairs.
template <int D, class T, class Scheme>
struct NearView : NearLists<D, T> {
  MphTerms<D, T, Scheme> mph;

  /// `terms`: those of the pairs, with the weights that the kernel is to know.
  static NearView make(const MphPairs<D>& pairs, const NearProducts<D>& near,
                       const MphTerms<D, double, Scheme>& terms) {
    const double unit = LocalPositions<D, T>::unit(pairs);
    return {NearLists<D, T>::make(pairs, near), terms.template inUnitsOf<T>(unit)};
  }
};

/// Of a pair whose difference is d.
template <int D, class T, class Scheme>
__device__ inline T gradientShape(const NearView<D, T, Scheme>& view, const Vec<D, T>& d) {
  T r2 = view.floor;
  for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
  return view.mph.gradientShape(PairDistance<T>{r2, inverseSqrt(r2)});
}

/// So many threads share a list, a power of two. (As a number that only the launch knows, it costs small systems
/// up to a tenth of a solve.)
template <int count>
using Threads = std::integral_constant<int, count>;

/// Runs along the list of a particle, every split-th entry from `part` on: add(load(entry)), the loads of four
/// neighbours being on their way together. Where lists are shared, threads are few and wait for memory; so the
/// last rows are loaded together, too, the particle itself in place of those that are missing, which adds nothing.
template <class Load, class Add, class Split = Threads<1>>
__device__ inline void alongList(const std::uint64_t* sliceStart, const std::uint32_t* entry, std::uint32_t i,
                                 Load&& load, Add&& add, int part = 0, Split split = {}) {
  constexpr int batch = 4;
  constexpr unsigned slice = nearSlice;
  const std::uint64_t begin = sliceStart[i / slice];
  const auto rows = static_cast<int>(sliceStart[i / slice + 1] - begin);
  const std::uint32_t* mine = entry + begin * slice + i % slice;
  const auto at = [&](int row) { return mine[static_cast<std::size_t>(row) * slice]; };
  const auto round = [&](int r, auto&& entryOf) {
    decltype(load(at(0))) loaded[batch];
#pragma unroll
    for (int k = 0; k < batch; ++k) loaded[k] = load(entryOf(r + k * split));
#pragma unroll
    for (int k = 0; k < batch; ++k) add(loaded[k]);
  };
  int r = part;
  if constexpr (split == 1) {
    for (; r + batch <= rows; r += batch) round(r, at);
    for (; r < rows; ++r) add(load(at(r)));
  } else {
    for (; r - part < rows; r += batch * split) round(r, [&](int row) { return row < rows ? at(row) : i; });
  }
}

/// Sum over groups of `split` consecutive lanes, in all of them.
template <class T>
__device__ inline T splitSum(T value, int split) {
  for (int offset = split / 2; offset > 0; offset /= 2) value += __shfl_xor_sync(~0u, value, offset);
  return value;
}

/// The lanes of the group that this thread is in, a bit each.
__device__ inline unsigned splitLanes(int split) {
  const unsigned lane = threadIdx.x % 32, part = threadIdx.x % split;
  return static_cast<unsigned>((std::uint64_t{1} << split) - 1) << (lane - part);
}

/// What a product reads of a particle: where it stands and the gathered quantity. `Fields` fetch both at once
/// where they stand side by side.
template <int D, class T>
struct PlacedValue {
  typename NearLists<D, T>::Stored x;
  T value;
};
template <int D, class T>
struct PlainScalars {
  const T* q;
  __device__ PlacedValue<D, T> own(const NearLists<D, T>& lists, std::uint32_t i) const {
    return {lists.own(i), q[i]};
  }
  __device__ PlacedValue<D, T> other(const NearLists<D, T>& lists, std::uint32_t j) const {
    return {lists.other(j), q[j]};
  }
};
/// B of the pressure gradient in the products of a case (renormalisation.hpp), and what stands in its place where
/// it has none: of(k) times d is what d is in particle k's column of C.
template <int D>
struct Renormalised {
  const SymmetricBlock<D>* b;
  std::uint32_t fluidCount;
  __device__ SymmetricBlock<D> of(std::uint32_t k) const {
    return k < fluidCount ? fetch(&b[k]) : SymmetricBlock<D>::identity();
  }
};
template <int D, class T>
struct Plain {
  struct Unit {
    __device__ friend Vec<D, T> operator*(Unit, const Vec<D, T>& d) { return d; }
  };
  __device__ Unit of(std::uint32_t) const { return {}; }
};

/// A pressure times its B.
template <int D, class T>
struct PlacedStress {
  typename NearLists<D, T>::Stored x;
  SymmetricBlock<D, T> value;
};
template <int D, class T, class Scalars, class Columns>
struct Stresses {
  Scalars q;
  Columns b;
  __device__ PlacedStress<D, T> own(const NearLists<D, T>& lists, std::uint32_t i) const {
    const PlacedValue<D, T> scalar = q.own(lists, i);
    return {scalar.x, scalar.value * b.of(i)};
  }
  __device__ PlacedStress<D, T> other(const NearLists<D, T>& lists, std::uint32_t j) const {
    const PlacedValue<D, T> scalar = q.other(lists, j);
    return {scalar.x, scalar.value * b.of(j)};
  }
};

/// sum += g (a + b) d of two pressures.
template <int D, class T>
__device__ inline void addPressures(Vec<D, T>& sum, T g, T a, T b, const Vec<D, T>& d) {
  addScaled(&sum[0], g * (a + b), d);
}
template <int D, class T>
__device__ inline void addPressures(Vec<D, T>& sum, T g, const SymmetricBlock<D, T>& a,
                                    const SymmetricBlock<D, T>& b, const Vec<D, T>& d) {
  addScaled(&sum[0], g, (a + b) * d);
}

template <int D, class T>
struct PlacedVelocity {
  typename NearLists<D, T>::Stored x;
  Vec<D, T> u;
};
/// Walls have none.
template <int D, class T, class V>
struct PlainVectors {
  const V* u;
  __device__ PlacedVelocity<D, T> own(const NearLists<D, T>& lists, std::uint32_t k) const {
    return {lists.own(k), k < lists.fluidCount ? fetch(&u[k]) : Vec<D, T>{}};
  }
  __device__ PlacedVelocity<D, T> other(const NearLists<D, T>& lists, std::uint32_t j) const {
    return {lists.other(j), j < lists.fluidCount ? fetch(&u[j]) : Vec<D, T>{}};
  }
};
/// `split` threads per own fluid particle: store(i, (C q)_i); reads positions and q of the neighbours. No atomics.
template <class Split, int D, class T, class Scheme, class Scalars, class Store>
__global__ void __launch_bounds__(128)
    nearGradientKernel(const Split split, const __grid_constant__ NearView<D, T, Scheme> view, const Scalars q,
                       const __grid_constant__ Store store) {
  waitForEarlierKernels();
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / split;
  if (split == 1 && own >= view.ownFluid) return;
  const std::uint32_t i = min(own, view.ownFluid - 1);  // all lanes of a warp take part in the sum
  const auto mine = q.own(view, i);
  Vec<D, T> sum{};
  decltype(ownOf(store, i)) owned{};  // where threads are few; many hide the wait, and want registers
  if constexpr (Split::value > 1) owned = ownOf(store, i);
  alongList(
      view.sliceStart, view.entry, i, [&](std::uint32_t j) { return q.other(view, j); },
      [&](const auto& other) {
        const Vec<D, T> d = view.difference(other.x, mine.x);
        addPressures(sum, gradientShape(view, d), mine.value, other.value, d);
      },
      thread % split, split);
  for (int k = 0; k < D; ++k) sum[k] = splitSum(sum[k], split);
  if (thread % split != 0 || own != i) return;
  if constexpr (Split::value == 1) owned = ownOf(store, i);
  put(store, i, view.mph.gradientFactor * sum, owned);
}

/// `split` threads per particle: store(k, (C^T u)_k), walls at rest; reads positions and u of the neighbours. No
/// atomics.
template <class Split, int D, class T, class Scheme, class Vectors, class Columns, class Store>
__global__ void __launch_bounds__(128)
    nearDivergenceKernel(const Split split, const __grid_constant__ NearView<D, T, Scheme> view, const Vectors u,
                         const Columns columns, const __grid_constant__ Store store) {
  waitForEarlierKernels();
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, own = thread / split;
  if (split == 1 && own >= view.activeCount) return;
  const std::uint32_t k = min(own, view.activeCount - 1);
  const auto mine = u.own(view, k);
  const auto b = columns.of(k);
  decltype(ownOf(store, k)) owned{};  // where threads are few; many hide the wait, and want registers
  if constexpr (Split::value > 1) owned = ownOf(store, k);
  T sum = 0;
  alongList(
      view.sliceStart, view.entry, k, [&](std::uint32_t j) { return u.other(view, j); },
      [&](const PlacedVelocity<D, T>& other) {
        const Vec<D, T> d = view.difference(other.x, mine.x);
        sum = fma(gradientShape(view, d), differenceAlong(other.u, mine.u, b * d), sum);
      },
      thread % split, split);
  sum = splitSum(sum, split);
  if (thread % split != 0 || own != k) return;
  if constexpr (Split::value == 1) owned = ownOf(store, k);
  put(store, k, -view.mph.gradientFactor * sum, owned);
}

/// Calls f(split): small systems leave lanes idle, and wait for the longest list.
template <int D, class F>
void withSplit(std::uint32_t particles, F&& f) {
  constexpr std::uint32_t threads = 1u << 17;  // what a card runs at a time
  if (D == 3 && particles < threads / 4)
    f(Threads<8>{});
  else if (particles < threads)
    f(Threads<4>{});
  else
    f(Threads<1>{});
}

template <int D, class T, class Scheme, class Scalars, class Store>
void nearGradient(const Context<Cuda>& context, const NearView<D, T, Scheme>& view, const Scalars& q,
                  const Store& store) {
  withSplit<D>(view.fluidCount, [&](auto split) {
    launchEarly(context, blocksFor(std::size_t{view.ownFluid} * split, 128), 128, 0,
                nearGradientKernel<decltype(split), D, T, Scheme, Scalars, Store>, split, view, q, store);
  });
}
template <int D, class T, class Scheme, class Vectors, class Columns, class Store>
void nearDivergence(const Context<Cuda>& context, const NearView<D, T, Scheme>& view, const Vectors& u,
                    const Columns& columns, const Store& store) {
  withSplit<D>(view.activeCount, [&](auto split) {
    launchEarly(context, blocksFor(std::size_t{view.activeCount} * split, 128), 128, 0,
                nearDivergenceKernel<decltype(split), D, T, Scheme, Vectors, Columns, Store>, split, view, u,
                columns, store);
  });
}

}  // namespace treacle
