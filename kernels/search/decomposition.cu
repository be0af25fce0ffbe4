#include "treacle/search/decomposition.hpp"

#include "search/cell_sort.cuh"
#include "search/decomposition.cuh"
#include "search/migration.cuh"
#include "treacle/core/block.hpp"
#include "treacle/core/device_link.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace treacle {
namespace {

/// Errors: RunError. Ghosts are not looked at.
template <int D>
void requireFinite(Context<Cuda>& context, const Particles<D, Cuda>& p, SortWorkspace<Cuda>& w) {
  const std::span<const Vec<D>> position = p.position;
  clearBytes(context, w.count.data(), sizeof(std::uint32_t));
  countNotFinite(context, position.first(p.fluidCount), w.count.data());
  countNotFinite(context, position.subspan(p.wallBegin()), w.count.data());
  if (const std::uint32_t bad = valueOnHost(context, w.count.data())) throwNotFinite(bad);
}

/// One thread per particle; reads its position; atomic sums of whole numbers per cell.
template <int D>
void addWork(Context<Cuda>& context, const CellGrid<D>& grid, std::span<const Vec<D>> position, std::uint32_t each,
             std::uint32_t* work) {
  forEach(context, position.size(), [grid, each, work, x = position.data()] __device__(std::size_t i) {
    atomicAdd(&work[grid.linear(grid.cellOf(x[i]))], each);
  });
}

/// One thread per fluid particle; reads its position, writes its key, behind those of what lower ranks own, and
/// its index; atomics no.
template <int D>
void findKeysBehindOwners(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
                          const std::int32_t* owner, SortWorkspace<Cuda>& w) {
  forEach(context, p.fluidCount,
          [grid, owner, bits = keyBits(grid), position = p.position.data(), key = w.key.data(),
           index = w.index.data()] __device__(std::size_t i) {
            const Vec<D> x = position[i];
            key[i] = grid.key(x) | static_cast<std::uint64_t>(owner[grid.linear(grid.cellOf(x))]) << bits;
            index[i] = static_cast<std::uint32_t>(i);
          });
}

/// One thread per rank and one for the end; reads positions in sorted order, in which owners ascend, writes where
/// the fluid in that rank's cells begins; atomics no.
template <int D>
void findFluidOfRanks(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
                      const std::uint32_t* index, const std::int32_t* owner, int ranks, std::uint32_t* begins) {
  forEach(context, ranks + 1,
          [grid, index, owner, begins, fluid = p.fluidCount,
           position = p.position.data()] __device__(std::size_t rank) {
            begins[rank] = countFirst(fluid, [&](std::uint32_t k) {
              return owner[grid.linear(grid.cellOf(position[index[k]]))] < static_cast<int>(rank);
            });
          });
}

/// One thread per ghost; reads its position and its neighbours', writes begin and end of its cell; atomics no.
/// Ghosts of a cell stand together.
template <int D>
void addGhostRanges(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
                    CellRanges<Cuda>& ranges) {
  const std::uint32_t first = p.fluidCount, end = p.wallBegin();
  forEach(context, end - first,
          [grid, first, end, position = p.position.data(), rangeBegin = ranges.fluidBegin.data(),
           rangeEnd = ranges.fluidEnd.data()] __device__(std::size_t ghost) {
            const auto cellOf = [&](std::uint32_t i) { return grid.linear(grid.cellOf(position[i])); };
            const auto i = static_cast<std::uint32_t>(first + ghost);
            const std::size_t cell = cellOf(i);
            if (i == first || cellOf(i - 1) != cell) rangeBegin[cell] = i;
            if (i + 1 == end || cellOf(i + 1) != cell) rangeEnd[cell] = i + 1;
          });
}

template <int D>
void sortFluid(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
               const std::int32_t* owner, CellRanges<Cuda>& ranges, SortWorkspace<Cuda>& w) {
  const std::size_t sorted = std::size_t{p.fluidCount} + p.wallCount();
  w.key.resize(context, sorted);
  w.index.resize(context, sorted);
  w.sortedIndex.resize(context, sorted);
  findKeysBehindOwners(context, grid, p, owner, w);
  ranges.key.resize(context, p.fluidCount);
  const int bits = keyBits(grid);
  sortGroup(context, 0, p.fluidCount, bits + rankBits(*context.communicator), w, ranges.key.data());
  forEach(context, p.fluidCount,
          [bits, key = ranges.key.data()] __device__(std::size_t k) { key[k] &= (std::uint64_t{1} << bits) - 1; });
  orderById(context, p.fluidCount, ranges.key.data(), p.id.data(), w.sortedIndex.data());
}

}  // namespace

template <int D>
void Decomposition<D, Cuda>::sort(Context<Cuda>& context, const CellGrid<D>& grid, Particles<D, Cuda>& p,
                                  CellRanges<Cuda>& ranges, SortWorkspace<Cuda>& w) {
  const Communicator& job = *context.communicator;
  if (keyBits(grid) + rankBits(job) > 63)
    throw InputError("the domain has too many search cells to be shared by " + std::to_string(job.size()) +
                     " processes");
  w.count.resize(context, 2 * job.size() + 3);  // for all numbers of the sort
  agreed(context, [&] { requireFinite(context, p, w); });
  if (!owners_.areKnown() || this->isUneven(job, p.fluidCount)) divide(context, grid, p);
  sortFluid(context, grid, p, owner_.data(), ranges, w);
  if (migrate(context, grid, p, w)) sortFluid(context, grid, p, owner_.data(), ranges, w);

  const std::uint32_t own = p.fluidCount;
  fillRanges(context, grid, {0, own, ranges.key.data(), w.sortedIndex.data(), keyBits(grid)}, p.position.data(),
             ranges.fluidBegin, ranges.fluidEnd, w.count.data());
  findActiveCells(context, grid, p, ranges, w);
  this->startHalo(job, own);
  listSentFluid(context, ranges, w);
  this->countGhostFluid(job);
  sortWalls(context, grid, p, ranges, w);
  this->countAll(job);

  if (halo_.someHaveNone) p.modes.drop();  // a process without fluid does not know how many there are
  arrange(context, p, w, halo_.fluid - own);
  context.halo = &halo_;
  halo_.reserve(context, sizeof(Block<D>));  // the largest there are: in a graph nothing can be allocated
  fillGhosts(context, Held::Fluid, p.position.data());
  fillGhosts(context, Held::Fluid, p.material.data());
  if (p.has.sides) fillGhosts(context, Held::Fluid, p.side.data());
  addGhostRanges(context, grid, p, ranges);
  giveUp(w.key, w.sortedKey, w.index, w.sortedIndex, w.field);
  context.giveUpScratch();
}

/// Gives the cells out anew by the work in them.
template <int D>
void Decomposition<D, Cuda>::divide(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p) {
  const Communicator& job = *context.communicator;
  const std::span<const Vec<D>> position = p.position;
  const auto fluid = position.first(p.fluidCount), walls = position.subspan(p.wallBegin());
  if (!owners_.areKnown()) {
    Buffer<Vec<D>> hostFluid, hostWalls;
    copyToHost(context, fluid, hostFluid), copyToHost(context, walls, hostWalls);
    this->assignFirst(job, grid, hostFluid, hostWalls);
  } else {
    // Walls that were own ones; there may be others in their places now, and then this is an estimate.
    const auto ownWalls = walls.first(std::min<std::size_t>(halo_.ownWalls, walls.size()));
    Buffer<std::uint32_t, Cuda> work(context, grid.cellCount());
    clearBytes(context, work.data(), work.size() * sizeof(std::uint32_t));
    addWork(context, grid, fluid, this->fluidWork, work.data());
    addWork(context, grid, ownWalls, this->wallWork, work.data());
    context.link->sum(work.data(), work.size());
    const Buffer<std::uint32_t> onHost = copyToHost(context, work);
    owners_.assign(grid, onHost, job.rank(), job.size());
  }
  adoptOwners(context, grid);
}

template <int D>
void Decomposition<D, Cuda>::adoptOwners(Context<Cuda>& context, const CellGrid<D>& grid) {
  const CellOwnersView owners = owners_.view();
  copyToDevice(context, std::span(owners.owner, grid.cellCount()), owner_);
  copyToDevice(context, std::span(owners.place, grid.cellCount()), place_);
  std::vector<std::uint32_t> cells, begins;
  for (const std::vector<std::uint32_t>& border : owners_.borders(grid, context.communicator->size())) {
    begins.push_back(static_cast<std::uint32_t>(cells.size()));
    cells.insert(cells.end(), border.begin(), border.end());
  }
  begins.push_back(static_cast<std::uint32_t>(cells.size()));
  copyToDevice(context, std::span<const std::uint32_t>(cells), borderCell_);
  copyToDevice(context, std::span<const std::uint32_t>(begins), borderBegin_);
}

template <int D>
bool Decomposition<D, Cuda>::migrate(Context<Cuda>& context, const CellGrid<D>& grid, Particles<D, Cuda>& p,
                                     SortWorkspace<Cuda>& w) {
  const Communicator& job = *context.communicator;
  const std::size_t size = job.size(), rank = job.rank();
  findFluidOfRanks(context, grid, p, w.sortedIndex.data(), owner_.data(), job.size(), w.count.data());
  std::vector<std::uint32_t> begins(size + 1), leaving(size), arriving(size);
  copyBytesToHost(context, w.count.data(), begins.data(), begins.size() * sizeof(std::uint32_t));
  for (std::size_t r = 0; r < size; ++r)
    if (r != rank) leaving[r] = begins[r + 1] - begins[r];
  const std::vector<std::uint32_t> all = job.table(leaving);
  if (std::ranges::count(all, 0u) == std::ssize(all)) return false;
  for (std::size_t r = 0; r < size; ++r) arriving[r] = all[r * size + rank];
  exchangeFluid(context, p, w, begins, arriving);
  return true;
}

#define TREACLE_INSTANTIATE(D)                                                                        \
  template void Decomposition<D, Cuda>::sort(Context<Cuda>&, const CellGrid<D>&, Particles<D, Cuda>&, \
                                             CellRanges<Cuda>&, SortWorkspace<Cuda>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
