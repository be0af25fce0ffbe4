#pragma once

#include "treacle/core/each.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/pair_sums.hpp"

#include <array>
#include <type_traits>

namespace treacle {

/// The particles of a cluster, as terms load values of them: at(f) has f(i) of each in its lane.
struct ClusterLanes {
  using Number = Lanes;
  template <class T>
  using Each = std::array<T, clusterSize>;
  template <int D>
  using Viscosity = ViscosityLanes<D>;

  ClusterRange range;

  template <class F>
  [[gnu::always_inline]] auto operator()(F&& f) const {
    using T = std::decay_t<decltype(f(std::uint32_t{}))>;
    if constexpr (std::is_floating_point_v<T>)
      return generate<Lanes>([&](auto lane) { return f(range.particle(lane)); });
    else if constexpr (requires { T::dimensions; })
      return vectors<T::dimensions>(f);
    else
      return each<T>(f);
  }
  template <int D>
  ViscosityLanes<D> viscosity(const MphPairs<D>& pairs) const {
    return ViscosityLanes<D>(pairs, range, 1);
  }

 private:
  template <int D, class F>
  [[gnu::always_inline]] VecLanes<D> vectors(F&& f) const {
    VecLanes<D> v;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) {
      const Vec<D> one = f(range.particle(lane));
      for (int k = 0; k < D; ++k) v[k][lane] = one[k];
    }
    return v;
  }
  template <class T, class F>
  [[gnu::always_inline]] Each<T> each(F&& f) const {
    Each<T> values;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) values[lane] = f(range.particle(lane));
    return values;
  }
};

template <class T, class F>
[[gnu::always_inline]] inline Lanes ofEach(const std::array<T, clusterSize>& values, F&& f) {
  return generate<Lanes>([&](auto lane) { return f(values[lane]); });
}

inline Lanes isAnother(const ClusterLanes& own, std::uint32_t other) {
  Lanes another = 1.0;
  const std::uint32_t lane = other - own.range.first;
  if (lane < clusterSize) another[lane] = 0;
  return another;
}

template <int D>
[[gnu::always_inline]] inline Lanes viscosityOf(const MphPairs<D>&, const ViscosityLanes<D>& own,
                                                std::uint32_t other) {
  return own.with(other);
}

template <int D, class F>
[[gnu::always_inline]] inline Lanes ofEachPair(const ClusterLanes& own, const VecLanes<D>& d, F&& f) {
  return generate<Lanes>([&](auto lane) {
    Vec<D> toOther;
    for (int k = 0; k < D; ++k) toOther[k] = d[k][lane];
    return f(own.range.particle(lane), toOther);
  });
}

template <bool Corrected, int D>
inline Lanes wallFactorOf(const MphPairs<D>& pairs, const ClusterLanes& own, std::uint32_t other,
                          const VecLanes<D>& d) {
  return Corrected ? wallFactors(pairs, own.range, other, d) : Lanes(1.0);
}

/// body(pairs, i) for particles i < count.
template <int D, class Body>
void forEachParticle(const Context<Cpu>&, const MphPairs<D>& pairs, std::size_t count, const Body& body) {
  parallelFor(count, parallelGrain, [&](std::size_t i) { body(pairs, static_cast<std::uint32_t>(i)); });
}

/// Clusters side by side; each adds up in registers.
template <int D, class Terms>
void sumOnList(Context<Cpu>&, const MphPairs<D>& pairs, const ClusterListView& list, const Terms& terms) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const auto own = terms.own(pairs, ClusterLanes{range});
    Lanes sum[Terms::values] = {};
    const auto addSegment = [&]<ListSegment segment>() {
      if constexpr (Terms::uses(segment))
        for (std::uint32_t j : list.segment(c, segment)) {
          const PairLanes<D> pair(pairs, j, x, floor2);
          terms.add(pairs, sum, pair.d, pair.r, own, otherOf(pairs, terms, j), segment);
        }
    };
    addSegment.template operator()<ListSegment::NearFluid>();
    addSegment.template operator()<ListSegment::FarFluid>();
    addSegment.template operator()<ListSegment::NearWall>();
    addSegment.template operator()<ListSegment::FarWall>();
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      if constexpr (requires { typename Terms::StoresAll; }) {
        double all[Terms::values];
        for (int n = 0; n < Terms::values; ++n) all[n] = sum[n][lane];
        terms.store(pairs, i, all);
      } else {
        for (int n = 0; n < Terms::values; ++n) terms.store(pairs, i, n, sum[n][lane]);
      }
    }
  });
}
template <int D, class Terms>
void sumOnFluid(Context<Cpu>& context, const MphPairs<D>& pairs, const Terms& terms) {
  sumOnList(context, pairs, pairs.fluidList, terms);
}
template <int D, class Terms>
void sumOnAll(Context<Cpu>& context, const MphPairs<D>& pairs, const Terms& terms) {
  sumOnList(context, pairs, pairs.fluidList, terms);
  sumOnList(context, pairs, pairs.wallList, terms);
}

}  // namespace treacle
