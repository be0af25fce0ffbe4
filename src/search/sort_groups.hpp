#pragma once

#include "treacle/core/parallel.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/touching_cells.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

namespace treacle {

// What the sort of a process's particles consists of, whether it is alone (cell_sort_cpu.cpp) or not
// (decomposition.cpp).

using KeyedIndex = SortWorkspace<>::KeyedIndex;

/// Keys of inactive walls sort behind those of all active ones.
constexpr std::uint64_t inactiveKey = std::uint64_t{1} << 63;

template <int D>
std::size_t cellAt(const CellGrid<D>& grid, const Vec<D>& x) {
  return grid.linear(grid.cellOf(x));
}

/// `each`: of a particle.
template <int D>
void addWork(const CellGrid<D>& grid, std::span<const Vec<D>> position, std::uint32_t each,
             std::vector<std::uint32_t>& work) {
  for (const Vec<D>& x : position) work[cellAt(grid, x)] += each;
}

/// Errors: RunError.
template <int D>
void requireFinite(std::span<const Vec<D>> position) {
  if (const auto bad = std::ranges::count_if(position, [](const auto& x) { return !isFinitePosition(x); }))
    throwNotFinite(static_cast<std::uint64_t>(bad));
}

/// Finds workspace.active. `hasFluid(cell)`.
template <int D, class HasFluid>
void markActiveCells(const CellGrid<D>& grid, const Particles<D>& p, const HasFluid& hasFluid,
                     SortWorkspace<>& workspace) {
  workspace.active.resize(grid.cellCount());
  std::fill(workspace.active.begin(), workspace.active.end(), std::uint8_t{0});
  const auto markAround = [&](std::size_t cell) {
    forEachAdjacentCell(grid, grid.cellAt(cell),
                        [&](const Vec<D, int>& c) { workspace.active[grid.linear(c)] = 1; });
  };
  for (std::size_t cell = 0; cell < workspace.active.size(); ++cell)
    if (hasFluid(cell)) markAround(cell);
  const BodySet rigid = rigidBodies(p.rigid);
  if (rigid.isEmpty()) return;
  workspace.bodies.resize(grid.cellCount());
  std::fill(workspace.bodies.begin(), workspace.bodies.end(), 0u);
  addBodies<D>(grid, p.position.span().subspan(p.wallBegin()), p.body.span().subspan(p.wallBegin()), rigid,
               workspace.bodies.span());
  for (std::size_t cell = 0; cell < workspace.active.size(); ++cell)
    if (mayTouchAround(grid, workspace.bodies.data(), grid.cellAt(cell))) workspace.active[cell] = 1;
}

/// Brings the fields of particles [begin, end) into the order of keyed[begin, end), which holds their keys and
/// indices. `before`: what sorts first.
template <int D, class Before>
void sortGroup(Particles<D>& particles, std::uint32_t begin, std::uint32_t end, SortWorkspace<>& workspace,
               const Before& before) {
  const std::span<KeyedIndex> keyed = workspace.keyed.span().subspan(begin, end - begin);
  if (std::is_sorted(keyed.begin(), keyed.end(), before)) return;  // walls at rest, most of the time
  std::sort(keyed.begin(), keyed.end(), before);
  // All room is taken before the first field: memory that gives out between two would leave particles with the
  // values of others.
  workspace.field.resize(particles.largestField(keyed.size(), keyed.size()));
  const auto permute = [&]<class T>(T* field, std::uint32_t first = 0) {  // one value per particle from `first` on
    static_assert(sizeof(T) <= sizeof(SymmetricBlock<D>));
    T* sorted = reinterpret_cast<T*>(workspace.field.data());
    parallelFor(keyed.size(), parallelGrain, [&](std::size_t i) { sorted[i] = field[keyed[i].index - first]; });
    std::memcpy(field + (begin - first), sorted, keyed.size() * sizeof(T));
  };
  const auto permuteField = [&](auto& field) { permute(field.data()); };
  forEachSharedFieldOf(permuteField, particles);
  if (begin > 0 || end > particles.fluidCount)
    return forEachWallFieldOf(
        [&](auto& field) {
          if (!field.empty()) permute(field.data(), particles.wallBegin());
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

}  // namespace treacle
