#include "treacle/search/process_parts.hpp"

#include "sort_groups.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace treacle {
namespace {

/// Grows by one where so much fluid has come in that it may fill other cells: a seventh to a quarter of what there
/// was.
int sizeClass(std::uint64_t fluid) {
  const int octave = std::bit_width(fluid);
  return octave < 3 ? 4 * octave : 4 * octave + static_cast<int>(fluid >> (octave - 3) & 3);
}

}  // namespace

template <int D, class Backend>
void ProcessParts<D, Backend>::assignFirst(const Communicator& job, const CellGrid<D>& grid,
                                           std::span<const Vec<D>> fluid, std::span<const Vec<D>> walls) {
  std::vector<std::uint32_t> work(grid.cellCount());
  addWork<D>(grid, fluid, fluidWork, work);
  job.sum(std::span(work));
  std::vector<std::uint8_t> active(grid.cellCount());
  for (std::size_t cell = 0; cell < work.size(); ++cell)
    if (work[cell] > 0)
      forEachAdjacentCell(grid, grid.cellAt(cell), [&](const Vec<D, int>& c) { active[grid.linear(c)] = 1; });
  for (const Vec<D>& x : walls)
    if (const std::size_t cell = cellAt(grid, x); active[cell]) work[cell] += wallWork;
  owners_.assign(grid, work, job.rank(), job.size());
}

template <int D, class Backend>
bool ProcessParts<D, Backend>::isUneven(const Communicator& job, std::uint32_t fluid) const {
  struct Owned {
    std::uint64_t fluid, work;
  };
  const Owned own{fluid, std::uint64_t{fluidWork} * fluid + std::uint64_t{wallWork} * halo_.ownWalls};
  std::uint64_t most = 0, total = 0, fluidOfAll = 0;
  for (const Owned& o : job.all(own)) most = std::max(most, o.work), total += o.work, fluidOfAll += o.fluid;
  const double imbalance = total > 0 ? static_cast<double>(most) * job.size() / static_cast<double>(total) : 1;
  if (imbalance <= mostImbalance) return false;
  return imbalance > 1.05 * owners_.imbalance() || sizeClass(fluidOfAll) > sizeClass(halo_.fluidOfAll);
}

template <int D, class Backend>
void ProcessParts<D, Backend>::startHalo(const Communicator& job, std::uint32_t ownFluid) {
  static_cast<HaloCounts&>(halo_) = {};
  halo_.ownFluid = halo_.fluid = ownFluid;
  halo_.neighbours.assign(job.size(), {});
  for (int r = 0; r < job.size(); ++r) halo_.neighbours[r].rank = r;
}

template <int D, class Backend>
void ProcessParts<D, Backend>::countGhostFluid(const Communicator& job) {
  const std::size_t size = job.size();
  std::vector<std::uint32_t> to(size);
  for (std::size_t r = 0; r < size; ++r) to[r] = halo_.neighbours[r].sentFluid;
  const std::vector<std::uint32_t> counts = job.table(to);
  for (std::size_t r = 0; r < size; ++r) halo_.fluid += halo_.neighbours[r].fluid = counts[r * size + job.rank()];
}

/// Processes that have nothing for each other are no neighbours.
template <int D, class Backend>
void ProcessParts<D, Backend>::countAll(const Communicator& job) {
  struct Owned {
    std::uint64_t fluid, walls;
  };
  const std::vector<Owned> all = job.all(Owned{halo_.ownFluid, halo_.ownWalls});
  for (int r = 0; r < job.size(); ++r) {
    if (r < job.rank()) halo_.fluidBefore += all[r].fluid, halo_.wallsBefore += all[r].walls;
    halo_.fluidOfAll += all[r].fluid;
    halo_.someHaveNone = halo_.someHaveNone || all[r].fluid == 0;
  }
  std::erase_if(halo_.neighbours, [](const auto& n) {
    return n.sentFluid == 0 && n.sentWalls == 0 && n.fluid == 0 && n.walls == 0;
  });
}

template class ProcessParts<2, Cpu>;
template class ProcessParts<3, Cpu>;
#ifdef TREACLE_HAS_CUDA
template class ProcessParts<2, Cuda>;
template class ProcessParts<3, Cuda>;
#endif

}  // namespace treacle
