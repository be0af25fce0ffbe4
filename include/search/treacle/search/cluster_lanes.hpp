#pragma once

#include "treacle/core/lanes.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/search/cluster_list.hpp"

#include <algorithm>

namespace treacle {

static_assert(laneCount == clusterSize);

/// D components of a vector quantity of the eight particles of a cluster.
template <int D>
using VecLanes = Vec<D, Lanes>;

/// The particles of one cluster; lanes past the end repeat the last particle and are not stored.
struct ClusterRange {
  std::uint32_t first, count;

  ClusterRange(std::uint32_t begin, std::uint32_t end) : first(begin), count(std::min(clusterSize, end - begin)) {}
  ClusterRange(const ClusterListView& list, std::uint32_t cluster)
      : ClusterRange(list.first + cluster * clusterSize, list.last) {}
  std::uint32_t particle(std::uint32_t lane) const { return first + std::min(lane, count - 1); }
};

template <int D>
inline VecLanes<D> loadLanes(const ClusterRange& range, std::span<const Vec<D>> values) {
  VecLanes<D> lanes;
  for (int k = 0; k < D; ++k)
    if (range.count == clusterSize) {
      const Vec<D>* first = &values[range.first];
      lanes[k] = generate<Lanes>([&](auto lane) { return first[lane][k]; });
    } else {
      lanes[k] = generate<Lanes>([&](auto lane) { return values[range.particle(lane)][k]; });
    }
  return lanes;
}

inline Lanes loadLanes(const ClusterRange& range, std::span<const double> values) {
  if (range.count == clusterSize) return load<Lanes>(&values[range.first]);
  return generate<Lanes>([&](auto lane) { return values[range.particle(lane)]; });
}

template <int D>
inline void storeLanes(const ClusterRange& range, const VecLanes<D>& lanes, std::span<Vec<D>> values) {
  for (std::uint32_t lane = 0; lane < range.count; ++lane)
    for (int k = 0; k < D; ++k) values[range.first + lane][k] = lanes[k][lane];
}

inline void storeLanes(const ClusterRange& range, const Lanes& lanes, std::span<double> values) {
  if (range.count == clusterSize) return store(lanes, &values[range.first]);
  for (std::uint32_t lane = 0; lane < range.count; ++lane) values[range.first + lane] = lanes[lane];
}

/// CellGrid::nearest for the differences of eight pairs.
template <int D, class T, class Abi>
inline void moveToNearest(const CellGrid<D>& grid, std::experimental::simd<T, Abi> (&d)[D]) {
  for (int k = 0; k < D; ++k) {
    if (!grid.periodic[k]) continue;
    const T length = static_cast<T>(grid.length[k]), half = static_cast<T>(0.5 * grid.length[k]);
    d[k] = select(d[k] > half, d[k] - length, select(d[k] < -half, d[k] + length, d[k]));
  }
}

/// Positions of a cluster that a periodic end may divide: all lanes at the image nearest to the first one.
template <int D>
inline VecLanes<D> loadPositions(const ClusterRange& range, std::span<const Vec<D>> position,
                                 const CellGrid<D>& grid) {
  VecLanes<D> x = loadLanes<D>(range, position);
  bool divided = false;
  for (int k = 0; k < D; ++k) {
    const double first = x[k][0];
    divided = divided || (grid.periodic[k] && any_of(abs(x[k] - first) >= 0.5 * grid.length[k]));
  }
  if (!divided) return x;
  for (int lane = 1; lane < laneCount; ++lane) {
    const Vec<D> y =
        grid.beside(position[range.first], position[range.particle(static_cast<std::uint32_t>(lane))]);
    for (int k = 0; k < D; ++k) x[k][lane] = y[k];
  }
  return x;
}

}  // namespace treacle
