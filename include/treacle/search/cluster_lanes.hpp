#pragma once

#include "treacle/core/lanes.hpp"
#include "treacle/search/cluster_list.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace treacle {

static_assert(laneCount == clusterSize);

/// D components of a vector quantity of the eight particles of a cluster.
template <int D>
struct VecLanes {
  Lanes c[D];
  Lanes& operator[](int k) { return c[k]; }
  const Lanes& operator[](int k) const { return c[k]; }
};

/// The particles of one cluster; lanes past the end repeat the last particle and are not stored.
struct ClusterRange {
  std::uint32_t first, count;

  ClusterRange(std::uint32_t begin, std::uint32_t end) : first(begin), count(std::min(clusterSize, end - begin)) {}
  ClusterRange(const ClusterListView& list, std::uint32_t cluster)
      : ClusterRange(list.first + cluster * clusterSize, list.last) {}
  std::uint32_t particle(std::uint32_t lane) const { return first + std::min(lane, count - 1); }
};

/// Eight consecutive vectors, components apart: loads and shuffles only.
template <int D>
inline VecLanes<D> transposed(const Vec<D>* v) {
  static_assert(D == 2 || D == 3);
  Lanes a[D];
  std::memcpy(a, v, sizeof(a));
  if constexpr (D == 2) {
    return {__builtin_shufflevector(a[0], a[1], 0, 2, 4, 6, 8, 10, 12, 14),
            __builtin_shufflevector(a[0], a[1], 1, 3, 5, 7, 9, 11, 13, 15)};
  } else {
    const Lanes x = __builtin_shufflevector(a[0], a[1], 0, 3, 6, 9, 12, 15, 0, 0);
    const Lanes y = __builtin_shufflevector(a[0], a[1], 1, 4, 7, 10, 13, 0, 0, 0);
    const Lanes z = __builtin_shufflevector(a[0], a[1], 2, 5, 8, 11, 14, 0, 0, 0);
    return {__builtin_shufflevector(x, a[2], 0, 1, 2, 3, 4, 5, 10, 13),
            __builtin_shufflevector(y, a[2], 0, 1, 2, 3, 4, 8, 11, 14),
            __builtin_shufflevector(z, a[2], 0, 1, 2, 3, 4, 9, 12, 15)};
  }
}

template <int D>
inline VecLanes<D> loadLanes(const ClusterRange& range, std::span<const Vec<D>> values) {
  if (range.count == clusterSize) return transposed<D>(&values[range.first]);
  Vec<D> copy[clusterSize];
  for (std::uint32_t lane = 0; lane < clusterSize; ++lane) copy[lane] = values[range.particle(lane)];
  return transposed<D>(copy);
}

inline Lanes loadLanes(const ClusterRange& range, std::span<const double> values) {
  Lanes lanes;
  if (range.count == clusterSize)
    std::memcpy(&lanes, &values[range.first], sizeof(lanes));
  else
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) lanes[lane] = values[range.particle(lane)];
  return lanes;
}

template <int D>
inline void storeLanes(const ClusterRange& range, const VecLanes<D>& lanes, std::span<Vec<D>> values) {
  for (std::uint32_t lane = 0; lane < range.count; ++lane)
    for (int k = 0; k < D; ++k) values[range.first + lane][k] = lanes[k][lane];
}

inline void storeLanes(const ClusterRange& range, Lanes lanes, std::span<double> values) {
  for (std::uint32_t lane = 0; lane < range.count; ++lane) values[range.first + lane] = lanes[lane];
}

/// CellGrid::nearest for the differences of eight pairs; Lane: eight numbers.
template <int D, class Lane>
inline void moveToNearest(const CellGrid<D>& grid, Lane (&d)[D]) {
  using T = std::remove_reference_t<decltype(d[0][0])>;
  for (int k = 0; k < D; ++k) {
    if (!grid.periodic[k]) continue;
    const T length = static_cast<T>(grid.length[k]), half = static_cast<T>(0.5 * grid.length[k]);
    d[k] = d[k] > half ? d[k] - length : d[k] < -half ? d[k] + length : d[k];
  }
}

/// Positions of a cluster that a periodic end may divide: all lanes at the image nearest to the first one.
template <int D>
inline VecLanes<D> loadPositions(const ClusterRange& range, std::span<const Vec<D>> position,
                                 const CellGrid<D>& grid) {
  VecLanes<D> x = loadLanes<D>(range, position);
  bool divided = false;
  for (int k = 0; k < D; ++k) {
    const Lanes away = x[k] - x[k][0];
    divided = divided || (grid.periodic[k] && anyAtMost(-max(away, -away), -0.5 * grid.length[k]));
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
