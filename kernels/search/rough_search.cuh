#pragma once

#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/neighbour_rows.hpp"

#include <algorithm>
#include <cstdint>

namespace treacle {

/// Candidates for neighbours by positions in single precision, from the lower corner of the domain: enough to tell
/// who is clearly inside or outside of the radii. Whoever is not is looked at again in double precision, so the
/// rows are those of the CPU.
/// General: the domain may be periodic, and have thin sheets.
template <int D, bool General>
struct RoughSearch {
  CellGrid<D> grid;
  CellRangesView cells;
  const Vec<D>* exact = nullptr;
  const float4* rough = nullptr;  // and the bits of a particle's word of sides
  bool hasSheets = false;
  double near2 = 0, far2 = 0;  // squares of the radii [m2]
  // The squares less and plus a bound on the error of rough ones.
  float nearIn = 0, nearOut = 0, farIn = 0, farOut = 0;
  Vec<D, float> length{};
  bool walls = false;
  const std::uint8_t* used = nullptr;  // per cell: whether its particles may have neighbours; null: all

  void setRadii(const RowRadii& radii) {
    near2 = radii.near * radii.near;
    far2 = radii.far * radii.far;
    double longest = 0;
    for (int k = 0; k < D; ++k) {
      length[k] = static_cast<float>(grid.length[k]);
      longest = std::max(longest, grid.length[k]);
    }
    // Two roundings of 2^-24 of the longest side per axis, twice the distance in the square, and a factor 4.
    const double error = 4 * 2 * D * 1.2e-7 * longest * radii.far;
    nearIn = static_cast<float>(near2 - error);
    nearOut = static_cast<float>(near2 + error);
    farIn = static_cast<float>(far2 - error);
    farOut = static_cast<float>(far2 + error);
  }

  /// Cells beside a particle's and its own; each has a slot.
  static constexpr int slots = D == 3 ? 27 : 9;

  static constexpr std::size_t noCell = ~std::size_t{0};

  /// Slots that are visited after each other, a plane of cells.
  static constexpr int planeSlots = 9;

  /// begin(slot) before each plane, and visit(n, cell) for its cells, slot + n, in the order of
  /// forEachAdjacentCell, with noCell outside the domain; nothing where there is no neighbour to be found.
  /// `Unrolled`: n is known to the compiler.
  template <bool Unrolled, class Begin, class Visit>
  __device__ void forEachCell(const Vec<D>& x, Begin&& begin, Visit&& visit) const {
    const Vec<D, int> centre = grid.cellOf(x);
    if (used && !used[grid.linear(centre)]) return;
    const auto wrapped = [&](int c, int axis) {
      return !grid.periodic[axis]    ? c
             : c < 0                 ? c + grid.count[axis]
             : c >= grid.count[axis] ? c - grid.count[axis]
                                     : c;
    };
    int slot = 0;
#pragma unroll 1
    for (int z = D == 3 ? -1 : 0; z <= (D == 3 ? 1 : 0); ++z) {
      const int cz = D == 3 ? wrapped(centre[D - 1] + z, D - 1) : 0;
      begin(slot);
      slot += planeSlots;
      const bool inZ = D != 3 || (cz >= 0 && cz < grid.count[D - 1]);
#pragma unroll(Unrolled ? 3 : 1)
      for (int y = -1; y <= 1; ++y) {
        const int cy = wrapped(centre[1] + y, 1);
        const bool inY = inZ && cy >= 0 && cy < grid.count[1];
        const std::size_t row = (std::size_t(cz) * grid.count[1] + cy) * grid.count[0];
#pragma unroll(Unrolled ? 3 : 1)
        for (int dx = -1; dx <= 1; ++dx) {
          const int cx = wrapped(centre[0] + dx, 0);
          visit(3 * (y + 1) + dx + 1, inY && cx >= 0 && cx < grid.count[0] ? row + cx : noCell);
        }
      }
    }
  }

  __device__ std::uint32_t begin(std::size_t cell) const {
    return walls ? cells.wallBegin[cell] : cells.fluidBegin[cell];
  }
  __device__ std::uint32_t end(std::size_t cell) const {
    return walls ? cells.wallEnd[cell] : cells.fluidEnd[cell];
  }

  enum Reach { Out, Far, Near };
  /// Where candidate j is, at a rough distance.
  __device__ Reach reach(float r2, const Vec<D>& x, std::uint32_t j) const {
    if (r2 > farOut) return Out;
    if (r2 < nearIn) return Near;
    if (r2 > nearOut && r2 < farIn) return Far;
    const double exact2 = norm2(grid.difference(x, exact[j]));
    return exact2 < near2 ? Near : exact2 < far2 ? Far : Out;
  }

  /// Stands for all candidates of a cell that have to be looked at again: there are more of them than bits.
  static constexpr std::uint32_t lookAgain = ~0u;

  /// The neighbours in a cell: a bit for each, counted by reach. Four candidates at a time: their loads are on
  /// their way together, and whether one is in doubt is asked once for all. Up to three beyond the cell are read.
  __device__ std::uint32_t inCell(std::size_t cell, const Vec<D>& x, const float4& own, std::uint32_t& near,
                                  std::uint32_t& far) const {
    constexpr std::uint32_t chunk = 4;
    const std::uint32_t first = begin(cell), last = end(cell);
    std::uint32_t bits = 0;
    for (std::uint32_t j = first; j < last; j += chunk) {
      std::uint32_t hits = 0, close = 0;
      bool doubtful = false;
#pragma unroll
      for (std::uint32_t c = 0; c < chunk; ++c) {
        const float r2 = squaredDistance(own, rough[j + c]);
        hits |= r2 < farIn ? 1u << c : 0;
        close |= r2 < nearIn ? 1u << c : 0;
        doubtful = doubtful || (r2 >= nearIn && r2 <= nearOut) || (r2 >= farIn && r2 <= farOut);
      }
      if (doubtful) {
        hits = close = 0;
        for (std::uint32_t c = 0; c < chunk && j + c < last; ++c) {
          const Reach found = reach(squaredDistance(own, rough[j + c]), x, j + c);
          hits |= found != Out ? 1u << c : 0;
          close |= found == Near ? 1u << c : 0;
        }
      }
      const std::uint32_t valid = last - j < chunk ? (1u << (last - j)) - 1 : (1u << chunk) - 1;
      hits &= valid;
      near += __popc(close & valid);
      far += __popc(hits & ~close);
      bits |= hits << ((j - first) & 31);
    }
    return last - first > 32 && bits != 0 ? lookAgain : bits;
  }

  /// hit(j, near) for the neighbours in a cell that has some.
  template <class Hit>
  __device__ void fromBits(std::size_t cell, std::uint32_t bits, const Vec<D>& x, const float4& own,
                           Hit&& hit) const {
    const std::uint32_t first = begin(cell);
    if (bits == lookAgain) {
      for (std::uint32_t j = first, last = end(cell); j < last; ++j) {
        const Reach found = reach(squaredDistance(own, rough[j]), x, j);
        if (found != Out) hit(j, found == Near);
      }
      return;
    }
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t j = first + __ffs(bits) - 1;
      const float r2 = squaredDistance(own, rough[j]);
      hit(j, r2 < nearIn || (r2 <= nearOut && norm2(grid.difference(x, exact[j])) < near2));
    }
  }

  __device__ float squaredDistance(const float4& a, const float4& b) const {
    const float d[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
    float sum = 0;
    for (int k = 0; k < D; ++k) {
      float away = fabsf(d[k]);
      if (General && grid.periodic[k]) away = fminf(away, length[k] - away);
      sum = fmaf(away, away, sum);
    }
    if (General && hasSheets && !sides::seeEachOther(__float_as_uint(a.w), __float_as_uint(b.w))) return INFINITY;
    return sum;
  }
};

}  // namespace treacle
