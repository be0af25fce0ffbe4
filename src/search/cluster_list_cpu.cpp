#include "treacle/search/cluster_list.hpp"

#include "treacle/core/lanes.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/model/geometry/side.hpp"
#include "treacle/search/cluster_lanes.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace treacle {
namespace {

/// The cells that a cluster's reach touches, counted on through periodic ends, each once.
template <int D>
struct Reach {
  Vec<D, int> first, last;
  Vec<D> lo, hi;       // of the cluster [m]
  double reach2;       // [m2], a little more than it is, for what the ends of cells are rounded by
  bool wraps = false;  // crosses a periodic end

  Reach(const CellGrid<D>& grid, const VecLanes<D>& x, double radius) : reach2(radius * radius * (1 + 1e-6)) {
    for (int k = 0; k < D; ++k) {
      lo[k] = hmin(x[k]);
      hi[k] = hmax(x[k]);
      first[k] = static_cast<int>(std::floor((lo[k] - radius - grid.origin[k]) * grid.inverseEdge[k]));
      last[k] = static_cast<int>(std::floor((hi[k] + radius - grid.origin[k]) * grid.inverseEdge[k]));
      if (!grid.periodic[k]) {
        first[k] = std::clamp(first[k], 0, grid.count[k] - 1);
        last[k] = std::clamp(last[k], 0, grid.count[k] - 1);
      }
      wraps = wraps || first[k] < 0 || last[k] >= grid.count[k];
      last[k] = std::min(last[k], first[k] + grid.count[k] - 1);
    }
  }
};

/// Whether a cell, counted on through periodic ends, may have particles within reach. Where the reach takes in a
/// whole periodic axis, another image of the cell may be nearer.
template <int D>
bool touches(const CellGrid<D>& grid, const Reach<D>& reach, const Vec<D, int>& cell) {
  double distance2 = 0;
  for (int k = 0; k < D; ++k) {
    if (grid.periodic[k] && reach.last[k] - reach.first[k] + 1 == grid.count[k]) continue;
    const double begin = grid.origin[k] + cell[k] * grid.edge[k], end = begin + grid.edge[k];
    const double away = std::max({0.0, begin - reach.hi[k], reach.lo[k] - end});
    distance2 += away * away;
  }
  return distance2 <= reach.reach2;
}

template <int D, class F>
void forEachCell(const CellGrid<D>& grid, const Reach<D>& reach, F&& f) {
  Vec<D, int> c = reach.first;
  while (true) {
    if (touches(grid, reach, c)) {
      Vec<D, int> cell = c;
      for (int k = 0; k < D; ++k) cell[k] += c[k] < 0 ? grid.count[k] : c[k] >= grid.count[k] ? -grid.count[k] : 0;
      f(grid.linear(cell));
    }
    int k = 0;
    while (k < D && ++c[k] > reach.last[k]) {
      c[k] = reach.first[k];
      ++k;
    }
    if (k == D) return;
  }
}

/// Thin sheets between the particles of a cluster and others.
struct Partition {
  const std::uint32_t* side;
  std::uint32_t own[clusterSize];
  bool someParted = false;

  Partition(const std::uint32_t* all, const ClusterRange& cluster) : side(all) {
    for (std::uint32_t lane = 0; side && lane < clusterSize; ++lane) own[lane] = side[cluster.particle(lane)];
  }
  /// Takes particle j out of reach of those that it is parted from.
  void part(std::uint32_t j, double far2, Lanes& r2) {
    const Lanes before = r2;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      if (!sides::seeEachOther(own[lane], side[j])) r2[lane] = std::numeric_limits<double>::infinity();
    someParted = someParted || (any_of(r2 <= far2) && any_of(before <= far2 && r2 > far2));
  }
};

/// What visits one cluster's neighbours; the pass that counts and the one that fills differ in the sink alone.
template <int D>
struct ListBuilder {
  const CellGrid<D>& grid;
  const CellRanges<>& ranges;
  std::span<const Vec<D>> position;
  ListRadii radii;
  const std::uint32_t* side;

  /// Calls sink(segment, index) for every neighbour of the cluster; returns whether its pairs are special.
  template <class Sink>
  bool visit(const ClusterRange& cluster, Sink&& sink) const {
    const double near2 = radii.near * radii.near, far2 = radii.far * radii.far;
    const Reach<D> reach(grid, loadPositions<D>(cluster, position, grid), std::max(radii.near, radii.far));
    const VecLanes<D> x = loadLanes<D>(cluster, position);
    const double longest2 = std::max(near2, far2);
    Partition partition(side, cluster);
    const auto visitRange = [&](std::uint32_t begin, std::uint32_t end, int firstSegment) {
      for (std::uint32_t j = begin; j < end; ++j) {
        VecLanes<D> d;
        for (int k = 0; k < D; ++k) d[k] = position[j][k] - x[k];
        if (reach.wraps) moveToNearest(grid, d.v);
        Lanes r2 = {};
        for (int k = 0; k < D; ++k) r2 += d[k] * d[k];
        if (side) partition.part(j, longest2, r2);
        if (any_of(r2 <= near2))
          sink(firstSegment, j);
        else if (any_of(r2 <= far2))
          sink(firstSegment + 1, j);
      }
    };
    forEachCell(grid, reach, [&](std::size_t cell) {
      visitRange(ranges.fluidBegin[cell], ranges.fluidEnd[cell], static_cast<int>(ListSegment::NearFluid));
      visitRange(ranges.wallBegin[cell], ranges.wallEnd[cell], static_cast<int>(ListSegment::NearWall));
    });
    return reach.wraps || partition.someParted;
  }
};

}  // namespace

template <int D>
void buildClusterList(Context<Cpu>&, const CellGrid<D>& grid, const CellRanges<>& ranges,
                      std::span<const Vec<D>> position, const ListScope& scope, ClusterList<>& list) {
  list.first = scope.first;
  list.last = scope.last;
  const std::uint32_t clusters = list.clusterCount();
  list.offset.resize(std::size_t{listSegments} * clusters + 1);
  list.special.resize(clusters);
  const ListBuilder<D> builder{grid, ranges, position, scope.radii, scope.side};
  const auto rangeOf = [&](std::size_t c) { return ClusterRange(list, static_cast<std::uint32_t>(c)); };

  list.offset[0] = 0;
  parallelForDynamic(clusters, parallelGrain / clusterSize, 8, [&](std::size_t c) {
    std::array<std::uint64_t, listSegments> count{};
    list.special[c] = builder.visit(rangeOf(c), [&](int segment, std::uint32_t) { ++count[segment]; });
    const bool fluid =
        count[static_cast<int>(ListSegment::NearFluid)] + count[static_cast<int>(ListSegment::FarFluid)] > 0;
    if (scope.onlyNextToFluid && !fluid) count = {};
    for (int s = 0; s < listSegments; ++s) list.offset[std::size_t{listSegments} * c + s + 1] = count[s];
  });
  for (std::size_t k = 1; k < list.offset.size(); ++k) list.offset[k] += list.offset[k - 1];

  list.entry.resize(list.offset[list.offset.size() - 1]);
  parallelForDynamic(clusters, parallelGrain / clusterSize, 8, [&](std::size_t c) {
    const std::uint64_t* offset = &list.offset[std::size_t{listSegments} * c];
    if (offset[0] == offset[listSegments]) return;
    std::array<std::uint64_t, listSegments> next{};
    for (int s = 0; s < listSegments; ++s) next[s] = offset[s];
    builder.visit(rangeOf(c), [&](int segment, std::uint32_t j) { list.entry[next[segment]++] = j; });
  });
}

template void buildClusterList<2>(Context<Cpu>&, const CellGrid<2>&, const CellRanges<>&, std::span<const Vec<2>>,
                                  const ListScope&, ClusterList<>&);
template void buildClusterList<3>(Context<Cpu>&, const CellGrid<3>&, const CellRanges<>&, std::span<const Vec<3>>,
                                  const ListScope&, ClusterList<>&);

}  // namespace treacle
