#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// What a cell is to a process: one of its own, one that touches one of its own, or none of both.
enum class CellPlace : std::uint8_t { Far, Beside, Own };

/// Owners and places per cell (CellGrid::linear) as loops read them; host or device memory.
struct CellOwnersView {
  const std::int32_t* owner = nullptr;
  const CellPlace* place = nullptr;

  TREACLE_HD bool isOwn(std::size_t cell) const { return place[cell] == CellPlace::Own; }
  TREACLE_HD bool isBesideOwn(std::size_t cell) const { return place[cell] == CellPlace::Beside; }
};

/// Which process owns which cells: blocks of about equal work, made by cutting the cells in two again and again,
/// each time across the longest side of those that have work. What processes share is then half to a fifth of what
/// it is between parts of the Hilbert curve, whose borders are rough (docs/notes/clusters.md). Every process knows
/// all owners.
template <int D>
class CellOwners {
 public:
  /// `work`: per cell (CellGrid::linear), the same at all processes.
  void assign(const CellGrid<D>& grid, std::span<const std::uint32_t> work, int rank, int size);

  bool areKnown() const { return !owner_.empty(); }
  int owner(std::size_t cell) const { return owner_[cell]; }
  /// Whether a cell is this process's, or touches one of its cells.
  bool isOwn(std::size_t cell) const { return view().isOwn(cell); }
  bool isBesideOwn(std::size_t cell) const { return view().isBesideOwn(cell); }
  CellOwnersView view() const { return {owner_.data(), place_.data()}; }
  std::size_t cellCount() const { return owner_.size(); }
  /// Per rank of `size`: own cells that touch those of that rank, in the order of the curve.
  std::vector<std::vector<std::uint32_t>> borders(const CellGrid<D>& grid, int size) const;
  /// Largest work of a process over the mean, as it was then.
  double imbalance() const { return imbalance_; }

  std::size_t bytes() const { return order_.bytes() + owner_.bytes() + place_.bytes(); }

 private:
  void orderCells(const CellGrid<D>& grid);
  void cut(const CellGrid<D>& grid, std::span<const std::uint32_t> work, std::span<std::uint32_t> cells, int first,
           int last);

  Buffer<std::uint32_t> order_;  // cells along the Hilbert curve
  Buffer<std::int32_t> owner_;
  Buffer<CellPlace> place_;
  double imbalance_ = 1;
};

}  // namespace treacle
