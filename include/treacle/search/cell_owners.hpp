#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// Which process owns which cells: contiguous parts of the Hilbert curve through all cells, of about equal work.
/// Every process knows all owners.
template <int D>
class CellOwners {
 public:
  /// Cuts the curve. `work`: per cell (CellGrid::linear), the same at all processes.
  void assign(const CellGrid<D>& grid, std::span<const std::uint32_t> work, int rank, int size);

  bool areKnown() const { return !owner_.empty(); }
  int owner(std::size_t cell) const { return owner_[cell]; }
  /// Whether a cell is this process's, or touches one of its cells.
  bool isOwn(std::size_t cell) const { return place_[cell] == Own; }
  bool isBesideOwn(std::size_t cell) const { return place_[cell] == Beside; }
  /// Largest work of a process over the mean, as it was when the curve was cut.
  double imbalance() const { return imbalance_; }

  std::size_t bytes() const { return order_.bytes() + owner_.bytes() + place_.bytes(); }

 private:
  enum Place : std::uint8_t { Far, Beside, Own };

  void orderCells(const CellGrid<D>& grid);

  Buffer<std::uint32_t> order_;  // cells along the curve
  Buffer<std::int32_t> owner_;
  Buffer<std::uint8_t> place_;
  double imbalance_ = 1;
};

}  // namespace treacle
