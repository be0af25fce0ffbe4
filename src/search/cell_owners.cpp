#include "treacle/search/cell_owners.hpp"

#include "treacle/search/hilbert.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace treacle {

template <int D>
void CellOwners<D>::orderCells(const CellGrid<D>& grid) {
  const std::size_t cells = grid.cellCount();
  if (order_.size() == cells) return;
  std::vector<std::uint64_t> key(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    const Vec<D, int> cell = grid.cellAt(c);
    Vec<D, std::uint32_t> p{};
    for (int k = 0; k < D; ++k) p[k] = static_cast<std::uint32_t>(cell[k]);
    key[c] = hilbertIndex<D>(p, grid.bits);
  }
  order_.resize(cells);
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
}

/// A cell goes to the process in whose share of the work the middle of its own lies.
template <int D>
void CellOwners<D>::assign(const CellGrid<D>& grid, std::span<const std::uint32_t> work, int rank, int size) {
  orderCells(grid);
  const std::size_t cells = grid.cellCount();
  owner_.resize(cells);
  place_.resize(cells);
  const double total = std::accumulate(work.begin(), work.end(), 0.0);
  std::vector<double> workOf(size);
  double before = 0;
  for (std::uint32_t cell : order_) {
    const double middle = total > 0 ? (before + 0.5 * work[cell]) / total : 0;
    owner_[cell] = std::min(size - 1, static_cast<int>(middle * size));
    workOf[owner_[cell]] += work[cell];
    before += work[cell];
  }
  imbalance_ = total > 0 ? *std::max_element(workOf.begin(), workOf.end()) * size / total : 1;
  std::fill(place_.begin(), place_.end(), CellPlace::Far);
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (owner_[cell] == rank)
      forEachAdjacentCell(grid, grid.cellAt(cell),
                          [&](const Vec<D, int>& c) { place_[grid.linear(c)] = CellPlace::Beside; });
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (owner_[cell] == rank) place_[cell] = CellPlace::Own;
}

template <int D>
std::vector<std::vector<std::uint32_t>> CellOwners<D>::borders(const CellGrid<D>& grid, int size) const {
  std::vector<std::vector<std::uint32_t>> cells(size);
  for (std::uint32_t cell : order_) {
    if (!isOwn(cell)) continue;
    forEachAdjacentCell(grid, grid.cellAt(cell), [&](const Vec<D, int>& c) {
      const std::size_t beside = grid.linear(c);
      if (isOwn(beside)) return;
      std::vector<std::uint32_t>& border = cells[owner_[beside]];
      if (border.empty() || border.back() != cell) border.push_back(cell);
    });
  }
  return cells;
}

template class CellOwners<2>;
template class CellOwners<3>;

}  // namespace treacle
