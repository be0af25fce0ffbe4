#pragma once

#include "core/launch.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/touching_cells.hpp"

#include <span>

namespace treacle {

// What the sort of a process's particles consists of on a device, whether it is alone (cell_sort.cu) or not
// (decomposition.cu).

/// Keys have so many bits. Those above them mark groups of particles, which sort behind the others: the sort needs
/// no pass over the empty bits up to the 63rd.
template <int D>
int keyBits(const CellGrid<D>& grid) {
  return D * (grid.bits + CellGrid<D>::subBits);
}

/// Sorts workspace.key and .index of [begin, end) into `sortedKey` (which starts with `begin`) and
/// workspace.sortedIndex, stably: equal keys stay in the order of their indices.
void sortGroup(Context<Cuda>& context, std::uint32_t begin, std::uint32_t end, int bits, SortWorkspace<Cuda>& w,
               std::uint64_t* sortedKey);

/// One thread per particle; reads its position; an atomic sum for each one that is not finite.
template <int D>
void countNotFinite(Context<Cuda>& context, std::span<const Vec<D>> position, std::uint32_t* count) {
  forEach(context, position.size(), [count, x = position.data()] __device__(std::size_t i) {
    if (!isFinitePosition(x[i])) atomicAdd(count, 1u);
  });
}

/// Particles of one kind, sorted by their cells; pointers to device memory.
struct SortedGroup {
  std::uint32_t first, size;   // the group will start with particle `first`
  const std::uint64_t* key;    // in ascending order
  const std::uint32_t* index;  // that the particles have had
  int bits;                    // of a key; those of inactive particles have one above them
};

/// One thread per particle of the group; reads its key and its neighbours' in the sort, the position of those at
/// an end of a run, writes begin and end of the run's cell and the number of particles that are not inactive;
/// atomics no. `activeCount`: zero before.
template <int D>
void fillRanges(Context<Cuda>& context, const CellGrid<D>& grid, const SortedGroup& group, const Vec<D>* position,
                Buffer<std::uint32_t, Cuda>& rangeBegin, Buffer<std::uint32_t, Cuda>& rangeEnd,
                std::uint32_t* activeCount) {
  for (Buffer<std::uint32_t, Cuda>* range : {&rangeBegin, &rangeEnd}) {
    range->resize(context, grid.cellCount());
    clearBytes(context, range->data(), range->size() * sizeof(std::uint32_t));
  }
  forEach(context, group.size, [=, begin = rangeBegin.data(), end = rangeEnd.data()] __device__(std::size_t k) {
    constexpr int cellShift = D * CellGrid<D>::subBits;
    const std::uint64_t* const key = group.key;
    if (key[k] >> group.bits) return;
    const std::uint64_t cell = key[k] >> cellShift;
    const bool starts = k == 0 || key[k - 1] >> cellShift != cell;
    const bool ends = k + 1 == group.size || key[k + 1] >> cellShift != cell;
    if (!starts && !ends) return;
    const std::size_t c = grid.linear(grid.cellOf(position[group.index[k]]));
    const auto i = static_cast<std::uint32_t>(group.first + k);
    if (starts) begin[c] = i;
    if (!ends) return;
    end[c] = i + 1;
    if (k + 1 == group.size || key[k + 1] >> group.bits) *activeCount = static_cast<std::uint32_t>(k + 1);
  });
}

/// One thread per wall particle; reads its position and body; atomic "or" to the word of its cell.
template <int D>
void addBodies(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p, const BodySet& rigid,
               std::uint32_t* words) {
  forEach(context, p.wallCount(),
          [grid, rigid, words, position = p.position.data() + p.wallBegin(),
           body = p.body.data() + p.wallBegin()] __device__(std::size_t i) {
            const Vec<D> x = position[i];
            if (isFinitePosition(x))
              atomicOr(&words[grid.linear(grid.cellOf(x))], wordOfBody(body[i], rigid.has(body[i])));
          });
}

/// Finds w.active. One thread per cell; reads whether it and the adjacent cells have fluid (their `fluid` is not
/// 0), and which bodies; atomics no.
template <int D, class Flag>
void markActiveCells(Context<Cuda>& context, const CellGrid<D>& grid, const Particles<D, Cuda>& p,
                     const Flag* fluid, SortWorkspace<Cuda>& w) {
  w.active.resize(context, grid.cellCount());
  const std::uint32_t* words = nullptr;
  if (const BodySet rigid = rigidBodies(p.rigid); !rigid.isEmpty()) {
    w.bodies.resize(context, grid.cellCount());
    clearBytes(context, w.bodies.data(), w.bodies.size() * sizeof(std::uint32_t));
    addBodies(context, grid, p, rigid, w.bodies.data());
    words = w.bodies.data();
  }
  forEach(context, grid.cellCount(), [grid, fluid, words, active = w.active.data()] __device__(std::size_t cell) {
    const Vec<D, int> at = grid.cellAt(cell);
    bool any = words && mayTouchAround(grid, words, at);
    forEachAdjacentCell(grid, at, [&](const Vec<D, int>& c) { any = any || fluid[grid.linear(c)] > 0; });
    active[cell] = any;
  });
}

/// One thread per value; reads from[index[i] - first], writes to[i]; atomics no.
template <class T>
void gather(const Context<Cuda>& context, const T* from, const std::uint32_t* index, std::size_t count, T* to,
            std::uint32_t first = 0) {
  forEach(context, count, [from, index, to, first] __device__(std::size_t i) { to[i] = from[index[i] - first]; });
}

/// Brings a field, which starts with particle `first`, into the order of `index`.
template <class T>
void permute(Context<Cuda>& context, SortWorkspace<Cuda>& w, const std::uint32_t* index, Buffer<T, Cuda>& field,
             std::uint32_t first = 0) {
  if (field.empty()) return;
  T* sorted = reinterpret_cast<T*>(w.field.data());
  gather(context, field.data(), index, field.size(), sorted, first);
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

}  // namespace treacle
