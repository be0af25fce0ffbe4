#pragma once

#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/search/cluster_lanes.hpp"

namespace treacle {

/// Squares of distances below this fraction of h_p count as this fraction: a particle meets itself in its
/// cluster's list, and two may coincide; their differences are then zero and so is every term, whatever 1/r.
inline constexpr double tinyDistance2 = 1e-20;

/// Where the particles of a cluster stand [m], and whether neighbours may be nearer across a periodic end, or be
/// parted from some of them by thin sheets.
template <int D>
struct ClusterPlaces {
  VecLanes<D> x;
  bool special;
  std::uint32_t side[clusterSize];  // where thin sheets are

  ClusterPlaces(const MphPairs<D>& pairs, const ClusterListView& list, const ClusterRange& range, std::uint32_t c)
      : x(loadLanes<D>(range, pairs.position)), special(list.special[c] != 0) {
    if (!special || !pairs.side) return;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) side[lane] = pairs.side[range.particle(lane)];
  }
};

/// One neighbour as the lanes of a cluster see it.
template <int D>
struct PairLanes {
  VecLanes<D> d;          // x_j - x_i [m]
  PairDistance<Lanes> r;  // [m2, 1/m]

  PairLanes(const Vec<D>& xj, const VecLanes<D>& x, double floor2) {
    for (int k = 0; k < D; ++k) d[k] = xj[k] - x[k];
    measure(floor2);
  }
  /// At the nearest images.
  PairLanes(const MphPairs<D>& pairs, std::uint32_t j, const ClusterPlaces<D>& own, double floor2) {
    const Vec<D>& xj = pairs.position[j];
    for (int k = 0; k < D; ++k) d[k] = xj[k] - own.x[k];
    if (own.special) moveToNearest(pairs.grid, d.v);
    measure(floor2);
    if (own.special && pairs.side) part(pairs.side[j], own.side);
  }

 private:
  void measure(double floor2) {
    Lanes r2 = {};
    for (int k = 0; k < D; ++k) r2 += d[k] * d[k];
    r.square = max(r2, Lanes(floor2));
    r.inverse = inverseSqrt(r.square);
  }
  /// All terms of pairs so far apart are zero.
  void part(std::uint32_t other, const std::uint32_t (&own)[clusterSize]) {
    constexpr double far = 1e15;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      if (!sides::seeEachOther(own[lane], other)) r.square[lane] = far * far, r.inverse[lane] = 1 / far;
  }
};

template <int D>
inline double distanceFloor2(const MphPairs<D>& pairs) {
  return tinyDistance2 * pairs.terms.pressureRadius * pairs.terms.pressureRadius;
}

/// Runs body(range, places, cluster) for every cluster of the list.
/// `flatten`: sums stay in registers only where everything is inlined.
template <int D, class F>
inline void forEachCluster(const MphPairs<D>& pairs, const ClusterListView& list, F&& body) {
  parallelFor(list.clusterCount(), parallelGrain / clusterSize, [&] [[gnu::flatten]] (std::size_t index) {
    const auto c = static_cast<std::uint32_t>(index);
    const ClusterRange range(list, c);
    body(range, ClusterPlaces<D>(pairs, list, range, c), c);
  });
}

/// The wall factors of the fluid particles of a cluster with a wall particle, and of the wall particles of a
/// cluster with a fluid particle; d: from the lanes' particles to it [m].
template <int D>
inline Lanes wallFactors(const MphPairs<D>& pairs, const ClusterRange& range, std::uint32_t j,
                         const VecLanes<D>& d) {
  Lanes factors = 1.0;
  if (!pairs.wallSurface) return factors;
  const bool wall = j >= pairs.fluidCount;
  for (std::uint32_t lane = 0; lane < range.count; ++lane) {
    Vec<D> toOther;
    for (int k = 0; k < D; ++k) toOther[k] = d[k][lane];
    const std::uint32_t i = range.particle(lane);
    factors[lane] = wall ? pairs.wallFactor(i, j, toOther) : pairs.wallFactor(j, i, -1.0 * toOther);
  }
  return factors;
}

/// Takes out of eight vectors v what MphPairs::alongWall says, of the fluid particles of a cluster and a wall
/// particle or of the wall particles of a cluster and a fluid particle; d: from the lanes' particles to it [m].
template <int D, class LaneVector>
inline void takeAlongWall(const MphPairs<D>& pairs, const ClusterRange& range, std::uint32_t j,
                          const LaneVector (&d)[D], LaneVector (&v)[D]) {
  const bool wall = j >= pairs.fluidCount;
  for (std::uint32_t lane = 0; lane < range.count; ++lane) {
    Vec<D> toOther, whole;
    for (int k = 0; k < D; ++k) toOther[k] = d[k][lane], whole[k] = v[k][lane];
    const std::uint32_t i = range.particle(lane);
    const Vec<D> along =
        wall ? pairs.alongWall(i, j, toOther, whole) : pairs.alongWall(j, i, -1.0 * toOther, whole);
    for (int k = 0; k < D; ++k) v[k][lane] = static_cast<typename LaneVector::value_type>(whole[k] - along[k]);
  }
}

/// The blocks of a cluster's particles, lane by lane, LaneVector having a lane for each.
template <class LaneVector, int D, class T>
inline SymmetricBlock<D, LaneVector> loadBlocks(const ClusterRange& range, const SymmetricBlock<D, T>* blocks) {
  SymmetricBlock<D, LaneVector> lanes;
  for (int at = 0; at < lanes.size; ++at)
    lanes.a[at] = generate<LaneVector>([&](auto lane) { return blocks[range.particle(lane)].a[at]; });
  return lanes;
}

/// MphPairs::corrected for eight vectors that meet the pressure of one particle.
template <int D>
inline VecLanes<D> corrected(const MphPairs<D>& pairs, std::uint32_t k, const VecLanes<D>& v) {
  if (!pairs.renormalisation || k >= pairs.fluidCount) return v;
  VecLanes<D> product;
  for (int r = 0; r < D; ++r) product[r] = pairs.renormalisation[k].row(r, v);
  return product;
}

/// mu_ij times the viscous factor, for the lanes of a cluster and a neighbour, scaled as MphPairs::viscosityOf.
/// MayBeScaled: false in loops for pairs without scales whose roundings depend on what else they could compute.
template <int D, bool MayBeScaled = true>
class ViscosityLanes {
 public:
  ViscosityLanes(const MphPairs<D>& pairs, const ClusterRange& range)
      : ViscosityLanes(pairs, range, pairs.terms.viscousFactor) {}
  /// mu_ij times another factor.
  ViscosityLanes(const MphPairs<D>& pairs, const ClusterRange& range, double factor)
      : pairs_(pairs), factor_(factor) {
    if (pairs.viscosityScale)
      scale_ = generate<Lanes>([&](auto lane) { return pairs.viscousSide(range.particle(lane)).scale; });
    if (pairs.isOneSubstance()) {
      ofSubstance_[0] = factor * pairs.onlyViscosity();
      return;
    }
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      substance_[lane] = pairs.substance(range.particle(lane));
    for (int m = 0; m < pairs.materials.count; ++m)
      ofSubstance_[m] = generate<Lanes>(
          [&](auto lane) { return factor * pairs.viscosity(substance_[lane], static_cast<Substance>(m)); });
  }
  Lanes with(std::uint32_t j) const {
    const Lanes& unscaled = ofSubstance_[pairs_.substance(j)];
    if (!MayBeScaled || !pairs_.viscosityScale) return unscaled;
    const double scale = pairs_.viscousSide(j).scale;
    const double own = scale_[0];
    const bool bothFluid = scale > 0 && own > 0;  // a cluster is all fluid or all wall
    if (bothFluid && pairs_.ownViscosities && !pairs_.isOneSubstance()) return ofMaterials(j);
    return unscaled * ((bothFluid ? 0.5 : 1.0) * (scale_ + scale));
  }

 private:
  Lanes ofMaterials(std::uint32_t j) const {
    const ViscousSide other = pairs_.viscousSide(j);
    return generate<Lanes>([&](auto lane) {
      return factor_ * pairs_.viscosityOf({substance_[lane], scale_[lane]}, other);
    });
  }

  const MphPairs<D>& pairs_;
  double factor_;
  Lanes scale_{};
  Substance substance_[clusterSize];  // of several materials
  Lanes ofSubstance_[maxMaterials];
};

}  // namespace treacle
