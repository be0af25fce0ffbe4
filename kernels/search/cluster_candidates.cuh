#pragma once

#include "treacle/search/cell_sort.hpp"
#include "treacle/search/cluster_list.hpp"

namespace treacle {

/// Walks the sorted cell ranges around one cluster; a warp works together, one lane per candidate. The order of the
/// candidates is that of the CPU's lists.
template <int D>
class ClusterCandidates {
 public:
  /// `count` particles from `first`; `position` of the whole set.
  __device__ ClusterCandidates(const CellGrid<D>& grid, const CellRangesView& cells, const Vec<D>* position,
                               std::uint32_t first, std::uint32_t count)
      : grid_(grid), cells_(cells), position_(position) {
#pragma unroll
    for (int t = 0; t < static_cast<int>(clusterSize); ++t) {
      const std::uint32_t i = first + (t < static_cast<int>(count) ? t : count - 1);
      x_[t] = position[i];
      for (int k = 0; k < D; ++k) {
        if (grid.periodic[k] && fabs(x_[t][k] - x_[0][k]) > 0.5 * grid.length[k])
          x_[t][k] -= grid.length[k] * round((x_[t][k] - x_[0][k]) / grid.length[k]);
        low_[k] = t == 0 ? x_[0][k] : fmin(low_[k], x_[t][k]);
        high_[k] = t == 0 ? x_[0][k] : fmax(high_[k], x_[t][k]);
      }
    }
  }

  /// Calls visit(entry, near, far, wall) for chunks of candidates, with all lanes of the warp: `near` where some
  /// particle of the cluster lies within radii.near, `far` where not, but within radii.far.
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
    const int lane = threadIdx.x % 32;
    for (int base = 0; base < cells; base += 32) {
      const Cell mine = lookUp(first, size, base + lane, cells, reach);
      for (unsigned left = __ballot_sync(~0u, mine.occupied); left != 0; left &= left - 1) {
        const int from = __ffs(left) - 1;
        const auto shared = [&](std::uint32_t v) { return __shfl_sync(~0u, v, from); };
        const std::uint32_t image = shared(mine.image);
        const std::uint32_t fluidBegin = shared(mine.fluidBegin), fluidEnd = shared(mine.fluidEnd);
        const std::uint32_t wallBegin = shared(mine.wallBegin), wallEnd = shared(mine.wallEnd);
        if (fluid) visitRange(fluidBegin, fluidEnd, image, false, radii, visit);
        if (walls) visitRange(wallBegin, wallEnd, image, true, radii, visit);
      }
    }
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
    for (int k = D - 1; k >= 0; --k) {
      const int turn = cell[k] < 0 ? -1 : cell[k] >= grid_.count[k] ? 1 : 0;
      cell[k] -= turn * grid_.count[k];
      result.image = 3 * result.image + (turn < 0 ? 2 : turn);
    }
    if (distance2 > reach * reach * (1 + 1e-9)) return result;  // a margin for the rounding of the cell's corner
    const std::size_t linear = grid_.linear(cell);
    result.fluidBegin = cells_.fluidBegin[linear], result.fluidEnd = cells_.fluidEnd[linear];
    result.wallBegin = cells_.wallBegin[linear], result.wallEnd = cells_.wallEnd[linear];
    result.occupied = result.fluidEnd > result.fluidBegin || result.wallEnd > result.wallBegin;
    return result;
  }

  template <class Visit>
  __device__ void visitRange(std::uint32_t begin, std::uint32_t end, std::uint32_t image, bool wall,
                             const ListRadii& radii, Visit&& visit) const {
    const double near2 = radii.near * radii.near, far2 = radii.far * radii.far;
    Vec<D> shift{};
    for (int k = 0; k < D; ++k) shift[k] = shiftOf(image, k);
    for (std::uint32_t chunk = begin; chunk < end; chunk += 32) {
      const std::uint32_t j = chunk + threadIdx.x % 32;
      double r2 = 1e300;
      if (j < end) {
        const Vec<D> xj = position_[j] + shift;
        double box2 = 0;
        for (int k = 0; k < D; ++k) {
          const double gap = fmax(fmax(xj[k] - high_[k], low_[k] - xj[k]), 0.0);
          box2 += gap * gap;
        }
        if (box2 <= fmax(near2, far2)) {
#pragma unroll
          for (int t = 0; t < static_cast<int>(clusterSize); ++t) r2 = fmin(r2, norm2(xj - x_[t]));
        }
      }
      const bool near = r2 <= near2;
      visit(ListEntry::make(j, image), near, !near && r2 <= far2, wall);
    }
  }

  const CellGrid<D>& grid_;
  const CellRangesView& cells_;
  const Vec<D>* position_;
  Vec<D> x_[clusterSize];
  Vec<D> low_{}, high_{};  // bounding box
};

}  // namespace treacle
