#include "search/cell_sort.cuh"

#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <array>

namespace treacle {
namespace {

/// One thread per fluid particle; reads its position, writes its key and index; atomics no.
template <int D>
void findFluidKeys(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& particles,
                   SortWorkspace<Cuda>& w) {
  forEach(context, particles.fluidCount,
          [grid, position = particles.position.data(), key = w.key.data(),
           index = w.index.data()] __device__(std::size_t i) {
            key[i] = grid.key(position[i]);
            index[i] = static_cast<std::uint32_t>(i);
          });
}

/// One thread per wall particle; reads its position and whether walls in its cell are active, writes its key and
/// index; atomics no.
template <int D>
void findWallKeys(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& particles,
                  SortWorkspace<Cuda>& w) {
  const std::uint64_t inactive = std::uint64_t{1} << keyBits(grid);
  forEach(context, particles.wallCount(),
          [grid, inactive, fluid = particles.fluidCount, position = particles.position.data(),
           active = w.active.data(), key = w.key.data(), index = w.index.data()] __device__(std::size_t wall) {
            const std::size_t i = fluid + wall;
            const Vec<D> x = position[i];
            key[i] = grid.key(x) | (active[grid.linear(grid.cellOf(x))] ? 0 : inactive);
            index[i] = static_cast<std::uint32_t>(i);
          });
}

/// Room for the largest field while it is permuted. Taken before the first one is: memory that gives out between
/// two fields would leave particles with the values of others.
template <int D>
void makeRoom(Context<Cuda>& context, const Particles<D, Cuda>& particles, SortWorkspace<Cuda>& w) {
  w.field.resize(context, std::max(particles.largestField(particles.count, particles.fluidCount),
                                   particles.modes.vectors.size() * sizeof(Vec<D, float>)));
}

}  // namespace

void sortGroup(Context<Cuda>& context, std::uint32_t begin, std::uint32_t end, int bits, SortWorkspace<Cuda>& w,
               std::uint64_t* sortedKey) {
  if (begin == end) return;
  std::size_t bytes = 0;
  void* temporary = nullptr;
  const auto sort = [&] {
    TREACLE_CUDA_CHECK(cub::DeviceRadixSort::SortPairs(temporary, bytes, w.key.data() + begin, sortedKey,
                                                       w.index.data() + begin, w.sortedIndex.data() + begin,
                                                       end - begin, 0, bits, context.stream()));
  };
  sort();  // asks for the size
  temporary = context.scratch(std::max<std::size_t>(bytes, 1));
  sort();
}

template <int D>
void sortByCell(Context<Cuda>& context, const CellGrid<D>& grid, Particles<D, Cuda>& particles,
                CellRanges<Cuda>& ranges, SortWorkspace<Cuda>& w) {
  const std::uint32_t fluid = particles.fluidCount, walls = particles.wallCount(), count = particles.count;
  const int bits = keyBits(grid);
  const Vec<D>* position = particles.position.data();
  w.key.resize(context, count);
  w.index.resize(context, count);
  w.sortedKey.resize(context, walls);
  w.sortedIndex.resize(context, count);
  std::array<std::uint32_t, 3> counts{};
  w.count.resize(context, counts.size());
  clearBytes(context, w.count.data(), sizeof(counts));

  countNotFinite<D>(context, particles.position, w.count.data() + 2);
  findFluidKeys(context, grid, particles, w);
  ranges.key.resize(context, fluid);
  sortGroup(context, 0, fluid, bits, w, ranges.key.data());
  fillRanges(context, grid, {0, fluid, ranges.key.data(), w.sortedIndex.data(), bits}, position, ranges.fluidBegin,
             ranges.fluidEnd, w.count.data());
  markActiveCells(context, grid, particles, ranges.fluidEnd.data(), w);

  findWallKeys(context, grid, particles, w);
  sortGroup(context, fluid, count, bits + 1, w, w.sortedKey.data());
  fillRanges(context, grid, {fluid, walls, w.sortedKey.data(), w.sortedIndex.data() + fluid, bits}, position,
             ranges.wallBegin, ranges.wallEnd, w.count.data() + 1);

  makeRoom(context, particles, w);
  permuteModes(context, w, particles);  // first: their kernel may have to be loaded, which takes memory
  const std::uint32_t* index = w.sortedIndex.data();
  const auto permuteField = [&](auto& field) { permute(context, w, index, field); };
  forEachSharedFieldOf(permuteField, particles);
  forEachFluidFieldOf(permuteField, particles);
  forEachWallFieldOf([&](auto& field) { permute(context, w, index + fluid, field, fluid); }, particles);
  giveUp(w.key, w.sortedKey, w.index, w.sortedIndex, w.field);
  context.giveUpScratch();
  copyBytesToHost(context, w.count.data(), counts.data(), sizeof(counts));
  if (counts[2] > 0) throwNotFinite(counts[2]);
  ranges.activeCount = fluid + counts[1];
}

template void sortByCell<2>(Context<Cuda>&, const CellGrid<2>&, Particles<2, Cuda>&, CellRanges<Cuda>&,
                            SortWorkspace<Cuda>&);
template void sortByCell<3>(Context<Cuda>&, const CellGrid<3>&, Particles<3, Cuda>&, CellRanges<Cuda>&,
                            SortWorkspace<Cuda>&);

}  // namespace treacle
