#pragma once

#include "treacle/model/geometry/side.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/cluster_list.hpp"

namespace treacle {

/// Walks the sorted cell ranges around one cluster; a warp works together, one lane per candidate. The order of
/// the candidates is that of the CPU's lists.
template <int D>
class ClusterCandidates {
 public:
  /// A warp's working memory.
  struct Shared {
    Vec<D> x[clusterSize];
    Vec<D> beside[clusterSize];       // the images nearest to the first one
    std::uint32_t side[clusterSize];  // where thin sheets are
    std::uint32_t entry[64];          // candidates near the cluster's bounding box, not yet tested
    bool wall[64];
  };

  /// `count` particles from `first`; `position` and `side` (sides; null: there are no thin sheets) of the whole
  /// set. With all lanes of the warp.
  __device__ ClusterCandidates(const CellGrid<D>& grid, const CellRangesView& cells, const Vec<D>* position,
                               const std::uint32_t* side, std::uint32_t first, std::uint32_t count, Shared& shared)
      : grid_(grid), cells_(cells), position_(position), side_(side), shared_(shared) {
    const std::uint32_t own = threadIdx.x % clusterSize, index = first + (own < count ? own : count - 1);
    const Vec<D> there = position[index], x = grid.beside(position[first], there);
    for (int k = 0; k < D; ++k) {
      low_[k] = high_[k] = x[k];
      for (int offset = 1; offset < static_cast<int>(clusterSize); offset *= 2) {
        low_[k] = fmin(low_[k], __shfl_xor_sync(~0u, low_[k], offset));
        high_[k] = fmax(high_[k], __shfl_xor_sync(~0u, high_[k], offset));
      }
    }
    __syncwarp();
    if (threadIdx.x % 32 < clusterSize) {
      shared.x[own] = there, shared.beside[own] = x;
      if (side) shared.side[own] = side[index];
    }
    __syncwarp();
  }

  /// Calls visit(index, near, far, wall) with all lanes of the warp, a candidate each: `near` where some particle
  /// of the cluster that sees the candidate lies within radii.near, `far` where not, but within radii.far. Returns
  /// whether the reach crosses a periodic end, or thin sheets part some particles from candidates that others see.
  template <class Visit>
  __device__ bool forEach(const ListRadii& radii, bool fluid, bool walls, Visit&& visit) const {
    Walk walk{radii, Reach(*this, fmax(radii.near, radii.far))};
    // Each lane looks one cell up; then all lanes go through the ranges found.
    for (int base = 0; base < walk.reach.cells; base += 32) {
      const Cell mine = lookUp(walk.reach, base + threadIdx.x % 32);
      for (unsigned left = __ballot_sync(~0u, mine.occupied); left != 0; left &= left - 1) {
        const int from = __ffs(left) - 1;
        const auto shared = [&](std::uint32_t v) { return __shfl_sync(~0u, v, from); };
        Vec<D> shift{};
        if (walk.reach.wraps)
          for (int k = 0; k < D; ++k) shift[k] = __shfl_sync(~0u, mine.shift[k], from);
        const std::uint32_t fluidBegin = shared(mine.fluidBegin), fluidEnd = shared(mine.fluidEnd);
        const std::uint32_t wallBegin = shared(mine.wallBegin), wallEnd = shared(mine.wallEnd);
        if (fluid) collect(walk, fluidBegin, fluidEnd, shift, false, visit);
        if (walls) collect(walk, wallBegin, wallEnd, shift, true, visit);
      }
    }
    test(walk, walk.queued, visit);
    return walk.reach.wraps || __any_sync(~0u, walk.someParted);
  }

 private:
  /// The cells that the cluster's reach touches, counted on through periodic ends, each once.
  struct Reach {
    Vec<D, int> first{}, size{};
    Vec<D, bool> around{};  // all cells of a periodic axis, each at an image that need not be the nearest
    int cells = 1;
    bool wraps = false;  // crosses a periodic end
    double radius;

    __device__ Reach(const ClusterCandidates& cluster, double radius) : radius(radius) {
      const CellGrid<D>& grid = cluster.grid_;
      for (int k = 0; k < D; ++k) {
        int a = static_cast<int>(floor((cluster.low_[k] - radius - grid.origin[k]) * grid.inverseEdge[k]));
        int b = static_cast<int>(floor((cluster.high_[k] + radius - grid.origin[k]) * grid.inverseEdge[k]));
        if (!grid.periodic[k]) {
          a = min(max(a, 0), grid.count[k] - 1);
          b = min(max(b, 0), grid.count[k] - 1);
        }
        wraps = wraps || a < 0 || b >= grid.count[k];
        around[k] = grid.periodic[k] && b - a + 1 >= grid.count[k];
        first[k] = a;
        size[k] = min(b - a + 1, grid.count[k]);
        cells *= size[k];
      }
    }
  };
  struct Walk {
    const ListRadii& radii;
    Reach reach;
    int queued = 0;           // candidates in Shared::entry
    bool someParted = false;  // among those that the lane has tested
  };
  struct Cell {
    bool occupied = false;
    Vec<D> shift{};  // of its particles, where they are counted on through a periodic end [m]
    std::uint32_t fluidBegin = 0, fluidEnd = 0, wallBegin = 0, wallEnd = 0;
  };

  __device__ Cell lookUp(const Reach& reach, int index) const {
    Cell result;
    if (index >= reach.cells) return result;
    Vec<D, int> cell{};
    double distance2 = 0;  // of the cell from the cluster's bounding box
    for (int k = 0, rest = index; k < D; rest /= reach.size[k], ++k) {
      const int c = reach.first[k] + rest % reach.size[k];
      const double lower = grid_.origin[k] + c * grid_.edge[k];
      const double gap = fmax(fmax(lower - high_[k], low_[k] - lower - grid_.edge[k]), 0.0);
      if (!reach.around[k]) distance2 += gap * gap;
      cell[k] = c;
    }
    const Vec<D, int> unwrapped = cell;
    for (int k = 0; k < D; ++k) {
      const int turn = cell[k] < 0 ? -1 : cell[k] >= grid_.count[k] ? 1 : 0;
      cell[k] -= turn * grid_.count[k];
      result.shift[k] = turn * grid_.length[k];
    }
    // The margin is for the rounding of the cell's corner. A cluster that a jump of the curve tears apart has a
    // large box with little in reach.
    const double reach2 = reach.radius * reach.radius * (1 + 1e-9);
    if (distance2 > reach2 || distanceToCell(unwrapped, reach.around) > reach2) return result;
    const std::size_t linear = grid_.linear(cell);
    result.fluidBegin = cells_.fluidBegin[linear], result.fluidEnd = cells_.fluidEnd[linear];
    result.wallBegin = cells_.wallBegin[linear], result.wallEnd = cells_.wallEnd[linear];
    result.occupied = result.fluidEnd > result.fluidBegin || result.wallEnd > result.wallBegin;
    return result;
  }

  /// Square of the distance of a cell from the nearest particle of the cluster [m2].
  __device__ double distanceToCell(const Vec<D, int>& cell, const Vec<D, bool>& around) const {
    double nearest2 = 1e300;
    for (int t = 0; t < static_cast<int>(clusterSize); ++t) {
      double distance2 = 0;
      for (int k = 0; k < D; ++k) {
        if (around[k]) continue;
        const double lower = grid_.origin[k] + cell[k] * grid_.edge[k], x = shared_.beside[t][k];
        const double gap = fmax(fmax(lower - x, x - lower - grid_.edge[k]), 0.0);
        distance2 += gap * gap;
      }
      nearest2 = fmin(nearest2, distance2);
    }
    return nearest2;
  }

  /// Queues the particles of a range that are within reach of the bounding box.
  template <class Visit>
  __device__ void collect(Walk& walk, std::uint32_t begin, std::uint32_t end, const Vec<D>& shift, bool wall,
                          Visit&& visit) const {
    // The margin is for the rounding of the shift.
    const double reach2 = walk.reach.radius * walk.reach.radius * (1 + 1e-9);
    int& queued = walk.queued;
    const int lane = threadIdx.x % 32;
    for (std::uint32_t chunk = begin; chunk < end; chunk += 32) {
      const std::uint32_t j = chunk + lane;
      bool inside = j < end;
      if (inside) {
        const Vec<D> xj = position_[j] + shift;
        double box2 = 0;
        for (int k = 0; k < D; ++k) {
          const double gap = fmax(fmax(xj[k] - high_[k], low_[k] - xj[k]), 0.0);
          if (!walk.reach.around[k]) box2 += gap * gap;
        }
        inside = box2 <= reach2;
      }
      const unsigned lanes = __ballot_sync(~0u, inside);
      if (inside) {
        const int place = queued + __popc(lanes & ((1u << lane) - 1));
        shared_.entry[place] = j;
        shared_.wall[place] = wall;
      }
      queued += __popc(lanes);
      if (queued < 32) continue;
      test(walk, 32, visit);
      queued -= 32;
      if (lane < queued) {
        shared_.entry[lane] = shared_.entry[lane + 32];
        shared_.wall[lane] = shared_.wall[lane + 32];
      }
      __syncwarp();
    }
  }

  /// Measures the first `count` of the queue against all particles of the cluster.
  template <class Visit>
  __device__ void test(Walk& walk, int count, Visit&& visit) const {
    __syncwarp();
    const int lane = threadIdx.x % 32;
    double r2 = 1e300, parted2 = 1e300;  // to the nearest one that sees the candidate, and that does not
    std::uint32_t j = 0;
    bool wall = false;
    if (lane < count) {
      j = shared_.entry[lane];
      wall = shared_.wall[lane];
      const Vec<D> xj = position_[j];
#pragma unroll
      for (int t = 0; t < static_cast<int>(clusterSize); ++t) {
        const Vec<D> d = xj - shared_.x[t];
        const double square = norm2(walk.reach.wraps ? grid_.nearest(d) : d);
        if (side_ && !sides::seeEachOther(shared_.side[t], side_[j]))
          parted2 = fmin(parted2, square);
        else
          r2 = fmin(r2, square);
      }
    }
    const double longest2 = walk.reach.radius * walk.reach.radius;
    walk.someParted = walk.someParted || (r2 <= longest2 && parted2 <= longest2);
    const bool near = r2 <= walk.radii.near * walk.radii.near;
    visit(j, near, !near && r2 <= walk.radii.far * walk.radii.far, wall);
    __syncwarp();
  }

  const CellGrid<D>& grid_;
  const CellRangesView& cells_;
  const Vec<D>* position_;
  const std::uint32_t* side_;
  Shared& shared_;
  Vec<D> low_{}, high_{};  // bounding box
};

}  // namespace treacle
