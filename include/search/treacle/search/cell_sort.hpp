#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace treacle {

/// Where the particles of each cell stand after the sort.
template <class Backend = Cpu>
struct CellRanges {
  /// Fluid and active walls come first, [0, activeCount). Walls are active where there is fluid in their own or an
  /// adjacent cell, or a rigid body there may touch another body; the others are too far away to take part in any
  /// sum.
  std::uint32_t activeCount = 0;
  std::uint32_t ghostWalls = 0;                         // the last active ones, which other processes own
  Buffer<std::uint32_t, Backend> fluidBegin, fluidEnd;  // per cell (CellGrid::linear): range of fluid particles
  Buffer<std::uint32_t, Backend> wallBegin, wallEnd;    // per cell: range of active wall particles
  Buffer<std::uint64_t, Backend> key;                   // per fluid particle, ascending: CellGrid::key

  std::size_t bytes() const {
    return fluidBegin.bytes() + fluidEnd.bytes() + wallBegin.bytes() + wallEnd.bytes() + key.bytes();
  }
};

/// The ranges as kernels and pair sums read them; host or device memory.
struct CellRangesView {
  const std::uint32_t* fluidBegin = nullptr;
  const std::uint32_t* fluidEnd = nullptr;
  const std::uint32_t* wallBegin = nullptr;
  const std::uint32_t* wallEnd = nullptr;
};

template <class Backend>
CellRangesView viewOf(const CellRanges<Backend>& r) {
  return {r.fluidBegin.data(), r.fluidEnd.data(), r.wallBegin.data(), r.wallEnd.data()};
}

template <class Backend = Cpu>
struct SortWorkspace;

template <>
struct SortWorkspace<Cpu> {
  struct KeyedIndex {
    std::uint64_t key;
    std::uint32_t index;
  };
  Buffer<KeyedIndex> keyed;
  Buffer<std::byte> field;       // a permuted copy of one field
  Buffer<std::uint8_t> active;   // per cell: walls in it are
  Buffer<std::uint32_t> bodies;  // per cell: wordOfBody of all walls in it; only with rigid bodies

  std::size_t bytes() const { return keyed.bytes() + field.bytes() + active.bytes() + bodies.bytes(); }
};

template <>
struct SortWorkspace<Cuda> {
  Buffer<std::uint64_t, Cuda> key, sortedKey;
  Buffer<std::uint32_t, Cuda> index, sortedIndex;
  Buffer<std::byte, Cuda> field;
  Buffer<std::uint8_t, Cuda> active;   // as above
  Buffer<std::uint32_t, Cuda> bodies;  // as above
  Buffer<std::uint32_t, Cuda> count;  // of active fluid, which is all, active walls, positions that are not finite

  std::size_t bytes() const {
    return key.bytes() + sortedKey.bytes() + index.bytes() + sortedIndex.bytes() + field.bytes() + active.bytes() +
           bodies.bytes() + count.bytes();
  }
};

/// No step leads to a position that is not finite: where there is one, memory was overwritten or has failed.
template <int D>
TREACLE_HD bool isFinitePosition(const Vec<D>& x) {
  const double sum = norm2(x);
  return sum - sum == 0;
}

[[noreturn]] inline void throwNotFinite(std::uint64_t particles) {
  throw RunError("the positions of " + std::to_string(particles) +
                 " particles are not finite, where no step leads: their memory was overwritten or has failed");
}

/// Sorts all fields by CellGrid::key, fluid, active and inactive walls each by itself, stably; fills the ranges.
/// Errors: RunError for positions that are not finite, before anything looks for neighbours around them.
template <int D>
void sortByCell(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
                SortWorkspace<>& workspace);
template <int D>
void sortByCell(Context<Cuda>&, const CellGrid<D>& grid, Particles<D, Cuda>& particles, CellRanges<Cuda>& ranges,
                SortWorkspace<Cuda>& workspace);

}  // namespace treacle
