#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/geometry/seen_face.hpp"
#include "treacle/model/geometry/side.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstdint>
#include <span>

namespace treacle {

struct IndexRange {
  std::uint32_t begin = 0, end = 0;
  TREACLE_HD std::uint32_t size() const { return end - begin; }
};

/// The own particles of each cell, all of whose particles are own or ghosts; [0, 0) where they are ghosts.
struct OwnRanges {
  CellRangesView cells;
  std::uint32_t ownFluid = 0, ownEnd = 0;  // SortedParticles

  TREACLE_HD IndexRange fluid(std::size_t cell) const {
    return below(ownFluid, cells.fluidBegin[cell], cells.fluidEnd[cell]);
  }
  TREACLE_HD IndexRange walls(std::size_t cell) const {
    return below(ownEnd, cells.wallBegin[cell], cells.wallEnd[cell]);
  }

 private:
  TREACLE_HD static IndexRange below(std::uint32_t own, std::uint32_t begin, std::uint32_t end) {
    return begin < own ? IndexRange{begin, end} : IndexRange{};
  }
};

/// Particles after the sort, in host or device memory. Particles [0, fluidCount) are fluid, [fluidCount,
/// activeCount) the walls near it; "per particle" means activeCount, "per fluid particle" fluidCount. Spans and
/// pointers belong to the step's owner.
template <int D>
struct SortedParticles {
  std::uint32_t fluidCount = 0, activeCount = 0;
  std::uint32_t ghostFluid = 0, ghostWalls = 0;  // the last ones of either, which other processes own
  std::span<const Vec<D>> position;              // [m]
  std::span<const std::uint8_t> material;
  const std::uint32_t* side = nullptr;  // per particle, of thin sheets (sides); null: the case has none
  const WallSurface<D>* wallSurface =
      nullptr;                         // of the first wall particle; null: the fluid meets walls as they are
  const std::uint8_t* body = nullptr;  // per particle
  const WallMotion<D>* wallMotion = nullptr;  // per body; null: no wall changes its velocity
  CellRangesView cells;
  const std::int32_t* owner = nullptr;  // per cell: the process whose it is; null in a simulation that is alone
  CellGrid<D> grid;
  double spacing = 0;  // l [m]

  /// The process's own particles are [0, ownFluid()) and [fluidCount, ownEnd()): what is computed per particle is
  /// computed for them, and sums over all particles are sums over them.
  TREACLE_HD std::uint32_t ownFluid() const { return fluidCount - ghostFluid; }
  TREACLE_HD std::uint32_t ownEnd() const { return activeCount - ghostWalls; }
  TREACLE_HD bool isOwn(std::uint32_t i) const { return i < fluidCount ? i < ownFluid() : i < ownEnd(); }

  /// Whether a thin sheet keeps two particles from acting on each other.
  TREACLE_HD bool areParted(std::uint32_t i, std::uint32_t j) const {
    return side && !sides::seeEachOther(side[i], side[j]);
  }

  TREACLE_HD const WallSurface<D>& surfaceOf(std::uint32_t wall) const { return wallSurface[wall - fluidCount]; }
  /// By how much the velocity of a body differs between two places, `way` apart: it turns.
  TREACLE_HD Vec<D> swirl(std::uint32_t wall, const Vec<D>& way) const {
    return wallMotion ? wallMotion[body[wall]].swirl(way) : Vec<D>{};
  }
  /// The velocity of a wall where d, from a fluid particle to a particle of the wall, crosses its surface; u: that
  /// of the wall particle.
  TREACLE_HD Vec<D> velocityAtSurface(std::uint32_t wall, const Vec<D>& d, const Vec<D>& u) const {
    if (!wallMotion || !wallSurface) return u;
    return u - swirl(wall, seenFace(surfaceOf(wall), d).behind() * d);
  }

  /// The cells' ranges of own particles.
  TREACLE_HD OwnRanges ownRanges() const { return {cells, ownFluid(), ownEnd()}; }

  /// f(i) for the own fluid particles of a cell; then for own walls.
  template <class F>
  TREACLE_HD void forEachOwnFluid(std::size_t cell, F&& f) const {
    const IndexRange own = ownRanges().fluid(cell);
    for (std::uint32_t i = own.begin; i < own.end; ++i) f(i);
  }
  template <class F>
  TREACLE_HD void forEachOwnWall(std::size_t cell, F&& f) const {
    const IndexRange own = ownRanges().walls(cell);
    for (std::uint32_t i = own.begin; i < own.end; ++i) f(i);
  }
};

}  // namespace treacle
