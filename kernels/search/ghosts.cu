#include "core/scan.hpp"
#include "search/cell_sort.cuh"
#include "search/decomposition.cuh"
#include "treacle/core/device_link.hpp"
#include "treacle/search/decomposition.hpp"

#include <vector>

// The particles that a process holds on a device, once it is clear which are its own: which walls, and who needs
// what of whom.

namespace treacle {
namespace {

/// One thread per cell; reads the end of its fluid, writes whether there is any; atomics no.
void markCellsWithFluid(Context<Cuda>& context, const Buffer<std::uint32_t, Cuda>& rangeEnd,
                        Buffer<std::uint8_t, Cuda>& cells) {
  cells.resize(context, rangeEnd.size());
  forEach(context, cells.size(), [end = rangeEnd.data(), flag = cells.data()] __device__(std::size_t cell) {
    flag[cell] = end[cell] > 0;
  });
}

/// One thread per wall particle; reads its position and what its cell is, writes its key, behind those of the
/// fluid, and its index; atomics no. Keys of ghosts have 1 + their rank above their own bits, those of inactive
/// walls a bit above these.
template <int D>
void findWallKeys(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
                  const CellOwnersView& owners, SortWorkspace<Cuda>& w) {
  const int bits = keyBits(grid);
  const std::uint64_t inactive = std::uint64_t{1} << rankBits(*context.communicator);
  forEach(
      context, p.wallCount(),
      [grid, bits, inactive, owners, begin = p.wallBegin(), position = p.position.data(), active = w.active.data(),
       key = w.key.data() + p.fluidCount, index = w.index.data() + p.fluidCount] __device__(std::size_t wall) {
        const std::size_t i = begin + wall;
        const Vec<D> x = position[i];
        const std::size_t cell = grid.linear(grid.cellOf(x));
        std::uint64_t group = inactive;
        if (active[cell] && owners.isOwn(cell)) group = 0;
        if (active[cell] && owners.isBesideOwn(cell)) group = 1 + static_cast<std::uint64_t>(owners.owner[cell]);
        key[wall] = grid.key(x) | group << bits;
        index[wall] = static_cast<std::uint32_t>(i);
      });
}

/// One thread per rank and one for the end; reads sorted keys, writes where the ghosts among the walls that are
/// that rank's begin: own walls end with those of the first rank; atomics no.
void findWallsOfRanks(Context<Cuda>& context, const std::uint64_t* key, std::uint32_t walls, int bits, int ranks,
                      std::uint32_t* begins) {
  forEach(context, ranks + 1, [=] __device__(std::size_t rank) {
    begins[rank] = countFirst(walls, [&](std::uint32_t k) { return key[k] >> bits < 1 + rank; });
  });
}

/// One thread per border; reads the range of its cell, writes how many particles it has; atomics no.
void countBorders(Context<Cuda>& context, std::span<const std::uint32_t> cell, const std::uint32_t* rangeBegin,
                  const std::uint32_t* rangeEnd, std::uint32_t* count) {
  forEach(context, cell.size(), [=, cell = cell.data()] __device__(std::size_t k) {
    count[k] = rangeEnd[cell[k]] - rangeBegin[cell[k]];
  });
}

/// One thread per border; reads the range of its cell, writes the particles in it from where the border's start;
/// atomics no.
void listBorders(Context<Cuda>& context, std::span<const std::uint32_t> cell, const std::uint32_t* rangeBegin,
                 const std::uint32_t* rangeEnd, const std::uint32_t* start, std::uint32_t* list) {
  forEach(context, cell.size(), [=, cell = cell.data()] __device__(std::size_t k) {
    std::uint32_t* to = list + start[k];
    for (std::uint32_t i = rangeBegin[cell[k]]; i < rangeEnd[cell[k]]; ++i) *to++ = i;
  });
}

}  // namespace

/// Whether walls of a cell are active is for its owner to see as for all who have them as ghosts.
template <int D>
void Decomposition<D, Cuda>::findActiveCells(Context<Cuda>& context, const CellGrid<D>& grid,
                                             const Particles<D, Cuda>& p, const CellRanges<Cuda>& ranges,
                                             SortWorkspace<Cuda>& w) {
  markCellsWithFluid(context, ranges.fluidEnd, fluidCells_);
  context.link->max(fluidCells_.data(), fluidCells_.size());
  markActiveCells(context, grid, p, fluidCells_.data(), w);
}

template <int D>
void Decomposition<D, Cuda>::countSent(Context<Cuda>& context, const Buffer<std::uint32_t, Cuda>& rangeBegin,
                                       const Buffer<std::uint32_t, Cuda>& rangeEnd, std::uint32_t* starts) {
  borderStart_.resize(context, borderCell_.size() + 1);
  clearBytes(context, borderStart_.data() + borderCell_.size(), sizeof(std::uint32_t));
  countBorders(context, borderCell_, rangeBegin.data(), rangeEnd.data(), borderStart_.data());
  sumBefore(context, borderStart_.span());
  gather(context, borderStart_.data(), borderBegin_.data(), borderBegin_.size(), starts);
}

template <int D>
void Decomposition<D, Cuda>::listSent(Context<Cuda>& context, const Buffer<std::uint32_t, Cuda>& rangeBegin,
                                      const Buffer<std::uint32_t, Cuda>& rangeEnd,
                                      std::span<const std::uint32_t> starts, Buffer<std::uint32_t, Cuda>& sent,
                                      std::uint32_t Neighbour::*count) {
  for (Neighbour& n : halo_.neighbours) n.*count = starts[n.rank + 1] - starts[n.rank];
  sent.resize(context, starts.back());
  listBorders(context, borderCell_, rangeBegin.data(), rangeEnd.data(), borderStart_.data(), sent.data());
}

template <int D>
void Decomposition<D, Cuda>::listSentFluid(Context<Cuda>& context, const CellRanges<Cuda>& ranges,
                                           SortWorkspace<Cuda>& w) {
  std::vector<std::uint32_t> starts(halo_.neighbours.size() + 1);
  countSent(context, ranges.fluidBegin, ranges.fluidEnd, w.count.data());
  copyBytesToHost(context, w.count.data(), starts.data(), starts.size() * sizeof(std::uint32_t));
  listSent(context, ranges.fluidBegin, ranges.fluidEnd, starts, halo_.sentFluid, &Neighbour::sentFluid);
}

template <int D>
void Decomposition<D, Cuda>::sortWalls(Context<Cuda>& context, const CellGrid<D>& grid,
                                       const Particles<D, Cuda>& p, CellRanges<Cuda>& ranges,
                                       SortWorkspace<Cuda>& w) {
  const std::uint32_t own = p.fluidCount, walls = p.wallCount(), begin = halo_.fluid;
  const int bits = keyBits(grid), groupBits = rankBits(*context.communicator);
  const int ranks = static_cast<int>(halo_.neighbours.size());
  std::uint32_t* const index = w.sortedIndex.data() + own;
  w.sortedKey.resize(context, walls);
  findWallKeys(context, grid, p, view(), w);
  sortGroup(context, own, own + walls, bits + groupBits + 1, w, w.sortedKey.data());
  orderById(context, walls, w.sortedKey.data(), p.id.data(), index);

  std::vector<std::uint32_t> counts(2 * ranks + 2);  // where what is for each rank starts, where its walls begin
  std::uint32_t* const onDevice = w.count.data();
  fillRanges(context, grid, {begin, walls, w.sortedKey.data(), index, bits + groupBits}, p.position.data(),
             ranges.wallBegin, ranges.wallEnd, onDevice + counts.size());
  countSent(context, ranges.wallBegin, ranges.wallEnd, onDevice);
  findWallsOfRanks(context, w.sortedKey.data(), walls, bits, ranks, onDevice + ranks + 1);
  copyBytesToHost(context, onDevice, counts.data(), counts.size() * sizeof(std::uint32_t));

  const std::span<const std::uint32_t> all = counts, starts = all.first(ranks + 1),
                                       begins = all.subspan(ranks + 1);
  listSent(context, ranges.wallBegin, ranges.wallEnd, starts, halo_.sentWalls, &Neighbour::sentWalls);
  halo_.ownWalls = begins.front();
  for (Neighbour& n : halo_.neighbours) n.walls = begins[n.rank + 1] - begins[n.rank];
  ranges.activeCount = begin + begins.back();
  ranges.ghostWalls = begins.back() - begins.front();
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void Decomposition<D, Cuda>::findActiveCells(Context<Cuda>&, const CellGrid<D>&,                      \
                                                        const Particles<D, Cuda>&, const CellRanges<Cuda>&,      \
                                                        SortWorkspace<Cuda>&);                                   \
  template void Decomposition<D, Cuda>::listSentFluid(Context<Cuda>&, const CellRanges<Cuda>&,                   \
                                                      SortWorkspace<Cuda>&);                                     \
  template void Decomposition<D, Cuda>::sortWalls(Context<Cuda>&, const CellGrid<D>&, const Particles<D, Cuda>&, \
                                                  CellRanges<Cuda>&, SortWorkspace<Cuda>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
