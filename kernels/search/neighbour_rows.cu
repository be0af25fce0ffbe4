#include "treacle/search/neighbour_rows.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"

#include <algorithm>

namespace treacle {
namespace {

/// LocalPositions in single precision, from the lower corner of the domain: enough to tell who is clearly inside
/// or outside of the radii. Whoever is not is looked at again in double precision, so the rows are those of the
/// CPU.
template <int D>
struct RoughSearch {
  CellGrid<D> grid;
  CellRangesView cells;
  const Vec<D>* exact;
  const float4* rough;
  double near2, far2;  // squares of the radii [m2]
  // The squares less and plus a bound on the error of rough ones.
  float nearIn = 0, nearOut = 0, farIn = 0, farOut = 0;
  Vec<D, float> length;
  bool walls;
  const std::uint8_t* used = nullptr;  // per cell: whether its particles may have neighbours; null: all

  /// hit(j, near) for the neighbours of particle i, in the order of forEachNeighbour.
  template <class Hit>
  __device__ void forEach(std::uint32_t i, Hit&& hit) const {
    const Vec<D> x = exact[i];
    const float4 own = rough[i];
    const Vec<D, int> centre = grid.cellOf(x);
    if (used && !used[grid.linear(centre)]) return;
    const auto wrapped = [&](int c, int axis) {
      return !grid.periodic[axis]    ? c
             : c < 0                 ? c + grid.count[axis]
             : c >= grid.count[axis] ? c - grid.count[axis]
                                     : c;
    };
    for (int z = D == 3 ? -1 : 0; z <= (D == 3 ? 1 : 0); ++z) {
      const int cz = D == 3 ? wrapped(centre[D - 1] + z, D - 1) : 0;
      if (D == 3 && (cz < 0 || cz >= grid.count[D - 1])) continue;
      for (int y = -1; y <= 1; ++y) {
        const int cy = wrapped(centre[1] + y, 1);
        if (cy < 0 || cy >= grid.count[1]) continue;
        const std::size_t row = (std::size_t(cz) * grid.count[1] + cy) * grid.count[0];
        for (int dx = -1; dx <= 1; ++dx) {
          const int cx = wrapped(centre[0] + dx, 0);
          if (cx >= 0 && cx < grid.count[0]) inCell(row + cx, x, own, hit);
        }
      }
    }
  }

  /// Four candidates at a time: their loads are on their way together, and most of them are out of reach.
  template <class Hit>
  __device__ void inCell(std::size_t cell, const Vec<D>& x, const float4& own, Hit&& hit) const {
    constexpr int chunk = 4;
    const std::uint32_t end = walls ? cells.wallEnd[cell] : cells.fluidEnd[cell];
    for (std::uint32_t j = walls ? cells.wallBegin[cell] : cells.fluidBegin[cell]; j < end; j += chunk) {
      float r2[chunk];
      bool any = false;
#pragma unroll
      for (int c = 0; c < chunk; ++c) {
        r2[c] = j + c < end ? squaredDistance(own, rough[j + c]) : INFINITY;
        any = any || r2[c] <= farOut;
      }
      if (!any) continue;
#pragma unroll
      for (int c = 0; c < chunk; ++c) {
        if (r2[c] > farOut) continue;
        if (r2[c] < nearIn || (r2[c] > nearOut && r2[c] < farIn)) {
          hit(j + c, r2[c] < nearIn);
          continue;
        }
        const double exact2 = norm2(grid.difference(x, exact[j + c]));
        if (exact2 < far2) hit(j + c, exact2 < near2);
      }
    }
  }

  __device__ float squaredDistance(const float4& a, const float4& b) const {
    const float d[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
    float sum = 0;
    for (int k = 0; k < D; ++k) {
      float away = fabsf(d[k]);
      if (grid.periodic[k]) away = fminf(away, length[k] - away);
      sum = fmaf(away, away, sum);
    }
    return sum;
  }
};

/// One thread per cell: whether it holds fluid and has walls in itself or beside it, as few cells do.
template <int D>
void markFluidNearWalls(const Context<Cuda>& context, const CellGrid<D>& grid, const CellRangesView& cells,
                        std::uint8_t* withEntry) {
  forEach(context, grid.cellCount(), [grid, cells, withEntry] __device__(std::size_t c) {
    bool any = false;
    if (cells.fluidEnd[c] > cells.fluidBegin[c])
      forEachAdjacentCell(grid, grid.cellAt(c), [&](const Vec<D, int>& cell) {
        const std::size_t other = grid.linear(cell);
        any = any || cells.wallEnd[other] > cells.wallBegin[other];
      });
    withEntry[c] = any;
  });
}

/// One thread per particle.
template <int D>
void findRoughPlaces(const Context<Cuda>& context, const CellGrid<D>& grid, std::span<const Vec<D>> x,
                     float4* rough) {
  forEach(context, x.size(), [grid, x, rough] __device__(std::size_t i) {
    const Vec<D> p = x[i] - grid.origin;
    rough[i] = {static_cast<float>(p[0]), static_cast<float>(p[1]), D == 3 ? static_cast<float>(p[D - 1]) : 0.0f,
                0};
  });
}

}  // namespace

/// Twice one thread per row: it counts its neighbours, then writes them. Reads the positions in the cells around
/// its particle. No atomics.
template <int D>
void findNeighbours(Context<Cuda>& context, const CellGrid<D>& grid, const CellRangesView& cells,
                    std::span<const Vec<D>> position, std::uint32_t fluidCount, std::uint32_t activeCount,
                    RowRadii radii, RowKind kind, NeighbourRows<Cuda>& rows) {
  const RowSearch search = RowSearch::make(kind, fluidCount, activeCount);
  Buffer<float4, Cuda> rough(context, activeCount);
  findRoughPlaces(context, grid, position.first(activeCount), rough.data());
  RoughSearch<D> around{.grid = grid,
                        .cells = cells,
                        .exact = position.data(),
                        .rough = rough.data(),
                        .near2 = radii.near * radii.near,
                        .far2 = radii.far * radii.far,
                        .length = {},
                        .walls = search.walls};
  Buffer<std::uint8_t, Cuda> nearWalls;
  if (search.walls) {
    nearWalls.resize(context, grid.cellCount());
    markFluidNearWalls(context, grid, cells, nearWalls.data());
    around.used = nearWalls.data();
  }
  double longest = 0;
  for (int k = 0; k < D; ++k) {
    around.length[k] = static_cast<float>(grid.length[k]);
    longest = std::max(longest, grid.length[k]);
  }
  // Two roundings of 2^-24 of the longest side per axis, twice the distance in the square, and a factor 4.
  const double error = 4 * 2 * D * 1.2e-7 * longest * radii.far;
  around.nearIn = static_cast<float>(around.near2 - error);
  around.nearOut = static_cast<float>(around.near2 + error);
  around.farIn = static_cast<float>(around.far2 - error);
  around.farOut = static_cast<float>(around.far2 + error);
  const std::size_t count = search.count;
  rows.first = search.first;
  rows.count = search.count;
  rows.start.resize(context, 2 * count + 1);
  std::uint64_t* start = rows.start.data();
  forEach(context, count, [=] __device__(std::size_t row) {
    std::uint32_t nearCount = 0, farCount = 0;
    around.forEach(search.first + static_cast<std::uint32_t>(row),
                   [&](std::uint32_t, bool isNear) { isNear ? ++nearCount : ++farCount; });
    start[row] = nearCount;
    start[count + row] = farCount;
  });
  rows.column.resize(context, startRows(context, rows.start));
  forEach(context, count, [=, column = rows.column.data()] __device__(std::size_t row) {
    std::uint64_t nearPlace = start[row], farPlace = start[count + row];
    around.forEach(search.first + static_cast<std::uint32_t>(row),
                   [&](std::uint32_t j, bool isNear) { column[isNear ? nearPlace++ : farPlace++] = j; });
  });
}

template void findNeighbours<2>(Context<Cuda>&, const CellGrid<2>&, const CellRangesView&, std::span<const Vec<2>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<Cuda>&);
template void findNeighbours<3>(Context<Cuda>&, const CellGrid<3>&, const CellRangesView&, std::span<const Vec<3>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<Cuda>&);

}  // namespace treacle
