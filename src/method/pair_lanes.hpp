#pragma once

#include "treacle/core/parallel.hpp"
#include "treacle/method/mph_pairs.hpp"
#include "treacle/search/cluster_lanes.hpp"

namespace treacle {

/// Squares of distances below this fraction of h_p count as this fraction: a particle meets itself in its
/// cluster's list, and two may coincide; their differences are then zero and so is every term, whatever 1/r.
inline constexpr double tinyDistance2 = 1e-24;

/// One neighbour as the lanes of a cluster see it.
template <int D>
struct PairLanes {
  VecLanes<D> d;   // x_j - x_i [m]
  Lanes inverseR;  // [1/m]

  PairLanes(const Vec<D>& xj, const VecLanes<D>& x, double floor2) {
    Lanes r2 = {};
    for (int k = 0; k < D; ++k) {
      d[k] = xj[k] - x[k];
      r2 += d[k] * d[k];
    }
    inverseR = inverseSqrt(max(r2, broadcast(floor2)));
  }

  /// (1/r - 1/h), zero outside the radius.
  Lanes reach(const PairTerm& term) const { return max(inverseR - term.inverseRadius, Lanes{}); }
};

template <int D>
inline double distanceFloor2(const MphPairs<D>& pairs) {
  return tinyDistance2 * pairs.pressureWeight.radius * pairs.pressureWeight.radius;
}

/// Runs body(range, lane positions, cluster) for every cluster of the list.
template <int D, class F>
inline void forEachCluster(const MphPairs<D>& pairs, const ClusterListView& list, F&& body) {
  parallelFor(list.clusterCount(), parallelGrain / clusterSize, [&](std::size_t index) {
    const auto c = static_cast<std::uint32_t>(index);
    const ClusterRange range(list, c);
    body(range, loadPositions<D>(range, pairs.position, pairs.grid), c);
  });
}

/// mu_ij times the viscous factor, for the lanes of a cluster, by the neighbour's material.
template <int D>
struct ViscosityLanes {
  Lanes ofMaterial[maxMaterials];

  ViscosityLanes(const MphPairs<D>& pairs, const ClusterRange& range) {
    if (pairs.materials.count == 1) {
      ofMaterial[0] = broadcast(pairs.viscosity.factor * pairs.materials.pairViscosity[0][0]);
      return;
    }
    for (int m = 0; m < pairs.materials.count; ++m)
      for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
        ofMaterial[m][lane] =
            pairs.viscosity.factor * pairs.materials.pairViscosity[pairs.material[range.particle(lane)]][m];
  }
};

}  // namespace treacle
