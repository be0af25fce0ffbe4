#pragma once

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
    ListEntry entry[64];  // candidates near the cluster's bounding box, not yet tested
    bool wall[64];
  };

  /// `count` particles from `first`; `position` of the whole set. With all lanes of the warp.
  __device__ ClusterCandidates(const CellGrid<D>& grid, const CellRangesView& cells, const Vec<D>* position,
                               std::uint32_t first, std::uint32_t count, Shared& shared)
      : grid_(grid), cells_(cells), position_(position), shared_(shared) {
    const std::uint32_t own = threadIdx.x % clusterSize;
    const Vec<D> x = grid.beside(position[first], position[first + (own < count ? own : count - 1)]);
    for (int k = 0; k < D; ++k) {
      low_[k] = high_[k] = x[k];
      for (int offset = 1; offset < static_cast<int>(clusterSize); offset *= 2) {
        low_[k] = fmin(low_[k], __shfl_xor_sync(~0u, low_[k], offset));
        high_[k] = fmax(high_[k], __shfl_xor_sync(~0u, high_[k], offset));
      }
    }
    __syncwarp();
    if (threadIdx.x % 32 < clusterSize) shared.x[own] = x;
    __syncwarp();
  }

  /// Calls visit(entry, near, far, wall) with all lanes of the warp, a candidate each: `near` where some particle
  /// of the cluster lies within radii.near, `far` where not, but within radii.far.
  template <class Visit>
  __device__ void forEach(const ListRadii& radii, bool fluid, bool walls, Visit&& visit) const {
    const double reach = fmax(radii.near, radii.far);
    Vec<D, int> first{}, size{};
    int cells = 1;
    for (int k = 0; k < D; ++k) {
      int a = static_cast<int>(floor((low_[k] - reach - grid_.origin[k]) * grid_.inverseEdge[k]));
      int b = static_cast<int>(floor((high_[k] + reach - grid_.origin[k]) * grid_.inverseEdge[k]));
      if (!grid_.periodic[k]) {
        a = min(max(a, 0), grid_.count[k] - 1);
        b = min(max(b, 0), grid_.count[k] - 1);
      }
      first[k] = a;
      size[k] = b - a + 1;
      cells *= size[k];
    }
    // Each lane looks one cell up; then all lanes go through the ranges found.
    int queued = 0;
    for (int base = 0; base < cells; base += 32) {
      const Cell mine = lookUp(first, size, base + threadIdx.x % 32, cells, reach);
      for (unsigned left = __ballot_sync(~0u, mine.occupied); left != 0; left &= left - 1) {
        const int from = __ffs(left) - 1;
        const auto shared = [&](std::uint32_t v) { return __shfl_sync(~0u, v, from); };
        const std::uint32_t image = shared(mine.image);
        const std::uint32_t fluidBegin = shared(mine.fluidBegin), fluidEnd = shared(mine.fluidEnd);
        const std::uint32_t wallBegin = shared(mine.wallBegin), wallEnd = shared(mine.wallEnd);
        if (fluid) collect(fluidBegin, fluidEnd, image, false, radii, queued, visit);
        if (walls) collect(wallBegin, wallEnd, image, true, radii, queued, visit);
      }
    }
    test(queued, radii, visit);
  }

 private:
  struct Cell {
    bool occupied = false;
    std::uint32_t image = 0, fluidBegin = 0, fluidEnd = 0, wallBegin = 0, wallEnd = 0;
  };

  __device__ double shiftOf(std::uint32_t image, int k) const {
    for (int a = 0; a < k; ++a) image /= 3;
    const std::uint32_t digit = image % 3;
    return digit == 0 ? 0.0 : digit == 1 ? grid_.length[k] : -grid_.length[k];
  }

  __device__ Cell lookUp(const Vec<D, int>& first, const Vec<D, int>& size, int index, int cells,
                         double reach) const {
    Cell result;
    if (index >= cells) return result;
    Vec<D, int> cell{};
    double distance2 = 0;  // of the cell from the cluster's bounding box
    for (int k = 0, rest = index; k < D; rest /= size[k], ++k) {
      const int c = first[k] + rest % size[k];
      const double lower = grid_.origin[k] + c * grid_.edge[k];
      const double gap = fmax(fmax(lower - high_[k], low_[k] - lower - grid_.edge[k]), 0.0);
      distance2 += gap * gap;
      cell[k] = c;
    }
    const Vec<D, int> unwrapped = cell;
    for (int k = D - 1; k >= 0; --k) {
      const int turn = cell[k] < 0 ? -1 : cell[k] >= grid_.count[k] ? 1 : 0;
      cell[k] -= turn * grid_.count[k];
      result.image = 3 * result.image + (turn < 0 ? 2 : turn);
    }
    // The margin is for the rounding of the cell's corner. A cluster that a jump of the curve tears apart has a
    // large box with little in reach.
    const double reach2 = reach * reach * (1 + 1e-9);
    if (distance2 > reach2 || distanceToCell(unwrapped) > reach2) return result;
    const std::size_t linear = grid_.linear(cell);
    result.fluidBegin = cells_.fluidBegin[linear], result.fluidEnd = cells_.fluidEnd[linear];
    result.wallBegin = cells_.wallBegin[linear], result.wallEnd = cells_.wallEnd[linear];
    result.occupied = result.fluidEnd > result.fluidBegin || result.wallEnd > result.wallBegin;
    return result;
  }

  /// Square of the distance of a cell from the nearest particle of the cluster [m2].
  __device__ double distanceToCell(const Vec<D, int>& cell) const {
    double nearest2 = 1e300;
    for (int t = 0; t < static_cast<int>(clusterSize); ++t) {
      double distance2 = 0;
      for (int k = 0; k < D; ++k) {
        const double lower = grid_.origin[k] + cell[k] * grid_.edge[k], x = shared_.x[t][k];
        const double gap = fmax(fmax(lower - x, x - lower - grid_.edge[k]), 0.0);
        distance2 += gap * gap;
      }
      nearest2 = fmin(nearest2, distance2);
    }
    return nearest2;
  }

  /// Queues the particles of a range that are within reach of the bounding box.
  template <class Visit>
  __device__ void collect(std::uint32_t begin, std::uint32_t end, std::uint32_t image, bool wall,
                          const ListRadii& radii, int& queued, Visit&& visit) const {
    const double reach2 = fmax(radii.near * radii.near, radii.far * radii.far);
    const int lane = threadIdx.x % 32;
    Vec<D> shift{};
    for (int k = 0; k < D; ++k) shift[k] = shiftOf(image, k);
    for (std::uint32_t chunk = begin; chunk < end; chunk += 32) {
      const std::uint32_t j = chunk + lane;
      bool inside = j < end;
      if (inside) {
        const Vec<D> xj = position_[j] + shift;
        double box2 = 0;
        for (int k = 0; k < D; ++k) {
          const double gap = fmax(fmax(xj[k] - high_[k], low_[k] - xj[k]), 0.0);
          box2 += gap * gap;
        }
        inside = box2 <= reach2;
      }
      const unsigned lanes = __ballot_sync(~0u, inside);
      if (inside) {
        const int place = queued + __popc(lanes & ((1u << lane) - 1));
        shared_.entry[place] = ListEntry::make(j, image);
        shared_.wall[place] = wall;
      }
      queued += __popc(lanes);
      if (queued < 32) continue;
      test(32, radii, visit);
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
  __device__ void test(int count, const ListRadii& radii, Visit&& visit) const {
    __syncwarp();
    const int lane = threadIdx.x % 32;
    double r2 = 1e300;
    ListEntry e{0};
    bool wall = false;
    if (lane < count) {
      e = shared_.entry[lane];
      wall = shared_.wall[lane];
      Vec<D> xj = position_[e.index()];
      if (e.image() != 0)
        for (int k = 0; k < D; ++k) xj[k] += shiftOf(e.image(), k);
#pragma unroll
      for (int t = 0; t < static_cast<int>(clusterSize); ++t) r2 = fmin(r2, norm2(xj - shared_.x[t]));
    }
    const bool near = r2 <= radii.near * radii.near;
    visit(e, near, !near && r2 <= radii.far * radii.far, wall);
    __syncwarp();
  }

  const CellGrid<D>& grid_;
  const CellRangesView& cells_;
  const Vec<D>* position_;
  Shared& shared_;
  Vec<D> low_{}, high_{};  // bounding box
};

}  // namespace treacle
