#include "treacle/search/cell_sort.hpp"

#include "core/launch.hpp"

#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <array>

namespace treacle {
namespace {

/// Keys have so many bits. The one above them marks inactive walls, which sort behind all active ones: the sort
/// needs no pass over the empty bits up to the 63rd.
template <int D>
int keyBits(const CellGrid<D>& grid) {
  return D * (grid.bits + CellGrid<D>::subBits);
}

/// Sorts workspace.key and .index of [begin, end) into `sortedKey` (which starts with `begin`) and
/// workspace.sortedIndex, stably: equal keys stay in the order of their indices.
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

/// One thread per particle; reads its position; an atomic sum for each one that is not finite.
template <int D>
void countNotFinite(Context<Cuda>& context, const Particles<D, Cuda>& particles, std::uint32_t* count) {
  forEach(context, particles.count, [count, position = particles.position.data()] __device__(std::size_t i) {
    if (!isFinitePosition(position[i])) atomicAdd(count, 1u);
  });
}

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

/// One thread per wall particle; reads its position and whether its cell is near fluid, writes its key and index;
/// atomics no.
template <int D>
void findWallKeys(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& particles,
                  SortWorkspace<Cuda>& w) {
  const std::uint64_t inactive = std::uint64_t{1} << keyBits(grid);
  forEach(context, particles.wallCount(),
          [grid, inactive, fluid = particles.fluidCount, position = particles.position.data(),
           hasFluid = w.hasFluid.data(), key = w.key.data(), index = w.index.data()] __device__(std::size_t wall) {
            const std::size_t i = fluid + wall;
            const Vec<D> x = position[i];
            const bool active = hasFluid[grid.linear(grid.cellOf(x))];
            key[i] = grid.key(x) | (active ? 0 : inactive);
            index[i] = static_cast<std::uint32_t>(i);
          });
}

/// One thread per particle of a sorted group; reads its key and its neighbours' in the sort, the position of those
/// at an end of a run, writes begin and end of the run's cell and the number of particles that are not inactive;
/// atomics no. `key`, `index`: of the group, which starts with particle `first`; `activeCount`: zero before.
template <int D>
void fillRanges(Context<Cuda>& context, const CellGrid<D>& grid, std::uint32_t first, std::uint32_t size,
                const std::uint64_t* key, const std::uint32_t* index, const Vec<D>* position,
                Buffer<std::uint32_t, Cuda>& rangeBegin, Buffer<std::uint32_t, Cuda>& rangeEnd,
                std::uint32_t* activeCount) {
  for (Buffer<std::uint32_t, Cuda>* range : {&rangeBegin, &rangeEnd}) {
    range->resize(context, grid.cellCount());
    clearBytes(context, range->data(), range->size() * sizeof(std::uint32_t));
  }
  const int bits = keyBits(grid);
  forEach(context, size, [=, begin = rangeBegin.data(), end = rangeEnd.data()] __device__(std::size_t k) {
    constexpr int cellShift = D * CellGrid<D>::subBits;
    if (key[k] >> bits) return;
    const std::uint64_t cell = key[k] >> cellShift;
    const bool starts = k == 0 || key[k - 1] >> cellShift != cell;
    const bool ends = k + 1 == size || key[k + 1] >> cellShift != cell;
    if (!starts && !ends) return;
    const std::size_t c = grid.linear(grid.cellOf(position[index[k]]));
    const auto i = static_cast<std::uint32_t>(first + k);
    if (starts) begin[c] = i;
    if (!ends) return;
    end[c] = i + 1;
    if (k + 1 == size || key[k + 1] >> bits) *activeCount = static_cast<std::uint32_t>(k + 1);
  });
}

/// One thread per cell; reads whether the adjacent cells have fluid, writes whether any has; atomics no.
template <int D>
void markCellsNearFluid(Context<Cuda>& context, const CellGrid<D>& grid, const CellRanges<Cuda>& ranges,
                        Buffer<std::uint8_t, Cuda>& hasFluid) {
  hasFluid.resize(context, grid.cellCount());
  forEach(context, grid.cellCount(),
          [grid, fluidEnd = ranges.fluidEnd.data(), near = hasFluid.data()] __device__(std::size_t cell) {
            bool any = false;
            forEachAdjacentCell(grid, grid.cellAt(cell),
                                [&](const Vec<D, int>& c) { any = any || fluidEnd[grid.linear(c)] > 0; });
            near[cell] = any;
          });
}

/// Room for the largest field while it is permuted. Taken before the first one is: memory that gives out between
/// two fields would leave particles with the values of others.
template <int D>
void makeRoom(Context<Cuda>& context, const Particles<D, Cuda>& particles, SortWorkspace<Cuda>& w) {
  w.field.resize(
      context, std::max(particles.count * sizeof(Vec<D>), particles.modes.vectors.size() * sizeof(Vec<D, float>)));
}

/// One thread per particle from `first` on, with which the field starts; reads it where the sorted index points,
/// writes it in order; atomics no.
template <class T>
void permute(Context<Cuda>& context, SortWorkspace<Cuda>& w, Buffer<T, Cuda>& field, std::uint32_t first = 0) {
  if (field.empty()) return;
  T* sorted = reinterpret_cast<T*>(w.field.data());
  forEach(context, field.size(),
          [sorted, from = field.data(), index = w.sortedIndex.data() + first, first] __device__(std::size_t i) {
            sorted[i] = from[index[i] - first];
          });
  copyBytesOnDevice(context, sorted, field.data(), field.size() * sizeof(T));
}

/// The same for the modes, one after the other in one field; one thread per particle and mode.
template <int D>
void permuteModes(Context<Cuda>& context, SortWorkspace<Cuda>& w, Particles<D, Cuda>& particles) {
  Buffer<Vec<D, float>, Cuda>& field = particles.modes.vectors;
  if (field.empty()) return;
  auto* sorted = reinterpret_cast<Vec<D, float>*>(w.field.data());
  forEach(context, field.size(),
          [sorted, from = field.data(), index = w.sortedIndex.data(),
           fluid = std::size_t{particles.fluidCount}] __device__(std::size_t k) {
            const std::size_t i = k % fluid;
            sorted[k] = from[k - i + index[i]];
          });
  copyBytesOnDevice(context, sorted, field.data(), field.size() * sizeof(Vec<D, float>));
}

}  // namespace

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

  countNotFinite(context, particles, w.count.data() + 2);
  findFluidKeys(context, grid, particles, w);
  ranges.key.resize(context, fluid);
  sortGroup(context, 0, fluid, bits, w, ranges.key.data());
  fillRanges(context, grid, 0, fluid, ranges.key.data(), w.sortedIndex.data(), position, ranges.fluidBegin,
             ranges.fluidEnd, w.count.data());
  markCellsNearFluid(context, grid, ranges, w.hasFluid);

  findWallKeys(context, grid, particles, w);
  sortGroup(context, fluid, count, bits + 1, w, w.sortedKey.data());
  fillRanges(context, grid, fluid, walls, w.sortedKey.data(), w.sortedIndex.data() + fluid, position,
             ranges.wallBegin, ranges.wallEnd, w.count.data() + 1);

  makeRoom(context, particles, w);
  permuteModes(context, w, particles);  // first: their kernel may have to be loaded, which takes memory
  const auto permuteField = [&](auto& field) { permute(context, w, field); };
  forEachSharedFieldOf(permuteField, particles);
  forEachFluidFieldOf(permuteField, particles);
  forEachWallFieldOf([&](auto& field) { permute(context, w, field, fluid); }, particles);
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
