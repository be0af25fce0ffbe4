#include "treacle/search/cell_owners.hpp"

#include "treacle/search/hilbert.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
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

/// Gives the cells to the processes [first, last). Both parts of a cut are in the order of their places along the
/// axis, so a plane that lies in both has a step. A cell goes to the part in whose share of the work the middle of
/// its own lies.
template <int D>
void CellOwners<D>::cut(const CellGrid<D>& grid, std::span<const std::uint32_t> work,
                        std::span<std::uint32_t> cells, int first, int last) {
  if (last - first == 1) {
    for (std::uint32_t cell : cells) owner_[cell] = first;
    return;
  }
  Vec<D, int> low = grid.count, high{};
  double total = 0;
  for (std::uint32_t cell : cells) {
    if (work[cell] == 0) continue;
    total += work[cell];
    const Vec<D, int> at = grid.cellAt(cell);
    for (int k = 0; k < D; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k] + 1);
  }
  int axis = 0;
  for (int k = 1; k < D; ++k)
    if ((high[k] - low[k]) * grid.edge[k] > (high[axis] - low[axis]) * grid.edge[axis]) axis = k;
  const auto place = [&](std::uint32_t cell) {
    const Vec<D, int> at = grid.cellAt(cell);
    std::uint64_t key = 0;
    for (int k = 0; k < D; ++k) key = key * grid.count[(axis + k) % D] + at[(axis + k) % D];
    return key;
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> placed;
  placed.reserve(cells.size());
  for (std::uint32_t cell : cells) placed.emplace_back(place(cell), cell);
  std::sort(placed.begin(), placed.end());

  const int middle = (first + last) / 2;
  const double share = total * (middle - first) / (last - first);
  double before = 0;
  std::size_t ofFirst = 0;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    cells[k] = placed[k].second;
    if (before + 0.5 * work[cells[k]] < share) ofFirst = k + 1;
    before += work[cells[k]];
  }
  cut(grid, work, cells.first(ofFirst), first, middle);
  cut(grid, work, cells.subspan(ofFirst), middle, last);
}

template <int D>
void CellOwners<D>::assign(const CellGrid<D>& grid, std::span<const std::uint32_t> work, int rank, int size) {
  orderCells(grid);
  const std::size_t cells = grid.cellCount();
  owner_.resize(cells);
  place_.resize(cells);
  std::vector<std::uint32_t> all(order_.begin(), order_.end());
  cut(grid, work, all, 0, size);
  std::vector<double> workOf(size);
  for (std::size_t cell = 0; cell < cells; ++cell) workOf[owner_[cell]] += work[cell];
  const double total = std::accumulate(workOf.begin(), workOf.end(), 0.0);
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
