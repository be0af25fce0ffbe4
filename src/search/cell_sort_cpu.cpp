#include "treacle/search/cell_sort.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cstring>

namespace treacle {
namespace {

using KeyedIndex = SortWorkspace<>::KeyedIndex;

/// Keys of inactive walls sort behind those of all active ones.
constexpr std::uint64_t inactive = std::uint64_t{1} << 63;

/// Sorts keyed[begin, end), which holds these particles' keys and indices, and brings their fields into its order.
template <int D>
void sortGroup(Particles<D>& particles, std::uint32_t begin, std::uint32_t end, SortWorkspace<>& workspace) {
  const std::span<KeyedIndex> keyed = workspace.keyed.span().subspan(begin, end - begin);
  const auto before = [](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  };
  if (std::is_sorted(keyed.begin(), keyed.end(), before)) return;  // walls at rest, most of the time
  std::sort(keyed.begin(), keyed.end(), before);
  // All room is taken before the first field: memory that gives out between two would leave particles with the
  // values of others.
  workspace.field.resize(keyed.size() * sizeof(Vec<D>));
  const auto permute = [&]<class T>(T* field, std::uint32_t first = 0) {  // one value per particle from `first` on
    static_assert(sizeof(T) <= sizeof(Vec<D>));
    T* sorted = reinterpret_cast<T*>(workspace.field.data());
    parallelFor(keyed.size(), parallelGrain, [&](std::size_t i) { sorted[i] = field[keyed[i].index - first]; });
    std::memcpy(field + (begin - first), sorted, keyed.size() * sizeof(T));
  };
  const auto permuteField = [&](auto& field) { permute(field.data()); };
  forEachSharedFieldOf(permuteField, particles);
  if (begin > 0 || end > particles.fluidCount)
    return forEachWallFieldOf(
        [&](auto& field) {
          if (!field.empty()) permute(field.data(), begin);
        },
        particles);
  forEachFluidFieldOf(permuteField, particles);
  for (std::uint32_t m = 0; m < particles.modeCount(); ++m)
    permute(particles.modes.vectors.data() + std::size_t{m} * particles.fluidCount);
}

template <int D>
void fillRanges(const CellGrid<D>& grid, std::span<const Vec<D>> position, std::uint32_t begin, std::uint32_t end,
                Buffer<std::uint32_t>& rangeBegin, Buffer<std::uint32_t>& rangeEnd) {
  rangeBegin.resize(grid.cellCount());
  rangeEnd.resize(grid.cellCount());
  std::fill(rangeBegin.begin(), rangeBegin.end(), 0);
  std::fill(rangeEnd.begin(), rangeEnd.end(), 0);
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::size_t cell = grid.linear(grid.cellOf(position[i]));
    if (rangeEnd[cell] == 0) rangeBegin[cell] = i;
    rangeEnd[cell] = i + 1;
  }
}

template <int D>
void markCellsNearFluid(const CellGrid<D>& grid, const CellRanges<>& ranges, const Particles<D>& particles,
                        Buffer<std::uint8_t>& hasFluid) {
  hasFluid.resize(grid.cellCount());
  std::fill(hasFluid.begin(), hasFluid.end(), std::uint8_t{0});
  for (std::uint32_t i = 0; i < particles.fluidCount; ++i) {
    const Vec<D, int> cell = grid.cellOf(particles.position[i]);
    if (ranges.fluidBegin[grid.linear(cell)] == i)
      forEachAdjacentCell(grid, cell, [&](const Vec<D, int>& c) { hasFluid[grid.linear(c)] = 1; });
  }
}

}  // namespace

template <int D>
void sortByCell(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
                SortWorkspace<>& workspace) {
  const std::uint32_t fluid = particles.fluidCount, count = particles.count;
  if (const auto bad =
          std::ranges::count_if(particles.position, [](const auto& x) { return !isFinitePosition(x); }))
    throwNotFinite(static_cast<std::uint64_t>(bad));
  workspace.keyed.resize(count);
  KeyedIndex* keyed = workspace.keyed.data();

  parallelFor(fluid, parallelGrain, [&](std::size_t i) {
    keyed[i] = {grid.key(particles.position[i]), static_cast<std::uint32_t>(i)};
  });
  sortGroup(particles, 0, fluid, workspace);
  ranges.key.resize(fluid);
  for (std::uint32_t i = 0; i < fluid; ++i) ranges.key[i] = keyed[i].key;
  fillRanges<D>(grid, particles.position, 0, fluid, ranges.fluidBegin, ranges.fluidEnd);
  markCellsNearFluid(grid, ranges, particles, workspace.hasFluid);

  parallelFor(count - fluid, parallelGrain, [&](std::size_t wall) {
    const auto i = static_cast<std::uint32_t>(fluid + wall);
    const Vec<D>& x = particles.position[i];
    const bool active = workspace.hasFluid[grid.linear(grid.cellOf(x))];
    keyed[i] = {grid.key(x) | (active ? 0 : inactive), i};
  });
  sortGroup(particles, fluid, count, workspace);
  ranges.activeCount = static_cast<std::uint32_t>(
      std::partition_point(keyed + fluid, keyed + count, [](const KeyedIndex& k) { return k.key < inactive; }) -
      keyed);
  fillRanges<D>(grid, particles.position, fluid, ranges.activeCount, ranges.wallBegin, ranges.wallEnd);
  giveUp(workspace.keyed, workspace.field);
}

template void sortByCell<2>(Context<Cpu>&, const CellGrid<2>&, Particles<2>&, CellRanges<>&, SortWorkspace<>&);
template void sortByCell<3>(Context<Cpu>&, const CellGrid<3>&, Particles<3>&, CellRanges<>&, SortWorkspace<>&);

}  // namespace treacle
