#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Blocks of rows, one per own fluid particle, and the columns that each can reach: the fluid in the cells of its
/// particles and in those around them. They are runs of particles that follow each other, since cells do on the
/// curve that particles are sorted along. A device brings a block's columns together in shared memory, where an
/// entry finds its own by a few bits.
struct ColumnBlocksView {
  static constexpr std::uint32_t rows = 128;                                              // of a block
  static constexpr std::uint32_t columnBits = 11, columns = 1u << columnBits, runs = 64;  // it has at most

  /// The columns from `begin` on have the places from `place` on, up to those of the next run.
  struct Run {
    std::uint32_t begin, place;
  };
  /// Without runs: the block reaches too many columns, as scattered particles do, and has no places for them.
  struct Size {
    std::uint32_t runs, columns;
  };
  const Run* run = nullptr;    // `runs` per block
  const Size* size = nullptr;  // per block
};

template <class Backend>
struct ColumnBlocks {
  Buffer<ColumnBlocksView::Run, Backend> run;
  Buffer<ColumnBlocksView::Size, Backend> size;

  ColumnBlocksView view() const { return {run.data(), size.data()}; }
  std::size_t bytes() const { return run.bytes() + size.bytes(); }
};

/// `fluid`: sorted positions of all own fluid particles; the ranges have ghosts, too.
template <int D>
void findColumnBlocks(Context<Cuda>&, const CellGrid<D>& grid, const CellRangesView& cells,
                      std::span<const Vec<D>> fluid, ColumnBlocks<Cuda>& blocks);

}  // namespace treacle
