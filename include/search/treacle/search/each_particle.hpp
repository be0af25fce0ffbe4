#pragma once

#include "treacle/core/copy_values.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/search/near_places.hpp"
#include "treacle/search/shared_buckets.hpp"
#include "treacle/search/sheet_sides.hpp"

namespace treacle {

// near_places.hpp, shared_buckets.hpp and sheet_sides.hpp for the sources of both backends, which instantiate
// them. A thread of a device has one particle or bucket; there are no atomics.

/// The values of these particles.
template <class T, class Backend>
void gatherToHost(Context<Backend>& context, std::span<const std::uint32_t> index, const T* from, T* host) {
  Buffer<T, Backend> some(context, index.size());
  T* const to = some.data();
  forEach(context, index.size(), [=] TREACLE_HD(std::size_t k) { to[k] = from[index[k]]; });
  copyToHost(context, std::span<const T>(some), host);
}

template <int D, class Backend>
void copyNear(Context<Backend>& context, const Surroundings<D>& near, const Particles<D, Backend>& particles,
              std::uint32_t walls, Particles<D>& host) {
  Buffer<std::uint32_t, Backend> index(context, std::size_t{particles.fluidCount} + walls);
  const Vec<D>* const position = particles.position.data();
  const auto isNear = [=] TREACLE_HD(std::uint32_t i) { return near.holds(position[i]); };
  const std::uint32_t fluid = listWhere(context, 0, particles.fluidCount, isNear, index.data());
  const std::uint32_t all = listWhere(context, particles.wallBegin(), walls, isNear, index.data(), fluid);
  host.resize(numbersOfSome(particles, fluid, all - fluid));
  const auto take = [&](std::uint32_t count) {
    return [&context, &index, count]<class T>(const Buffer<T, Backend>& from, Buffer<T>& to) {
      gatherToHost(context, index.span().first(count), from.data(), to.data());
    };
  };
  forEachSharedFieldOf(take(all), particles, host);
  forEachFluidFieldOf(take(fluid), particles, host);
}

template <class Backend>
void bucketCells(Context<Backend>& context, std::span<const std::uint64_t> key,
                 std::span<const std::uint32_t> begin, int shift, std::span<std::uint64_t> cells) {
  forEach(context, cells.size(), [=] TREACLE_HD(std::size_t b) { cells[b] = key[begin[b]] >> shift; });
}

template <int D, class Backend>
void sortKeys(Context<Backend>& context, const CellGrid<D>& grid, std::span<const Vec<D>> position,
              std::span<std::uint64_t> key) {
  forEach(context, position.size(), [=] TREACLE_HD(std::size_t i) { key[i] = grid.key(position[i]); });
}

template <int D, class Backend>
void updateSides(Context<Backend>& context, std::span<const PlacedSheet<D>> sheets,
                 std::span<const Vec<D>> position, std::span<std::uint32_t> side) {
  forEach(context, side.size(),
          [=] TREACLE_HD(std::size_t i) { side[i] = updatedSide(sheets, position[i], side[i]); });
}

#define TREACLE_EACH_PARTICLE(D, Backend)                                                                        \
  template void copyNear(Context<Backend>&, const Surroundings<D>&, const Particles<D, Backend>&, std::uint32_t, \
                         Particles<D>&);                                                                         \
  template void sortKeys(Context<Backend>&, const CellGrid<D>&, std::span<const Vec<D>>,                         \
                         std::span<std::uint64_t>);                                                              \
  template void updateSides(Context<Backend>&, std::span<const PlacedSheet<D>>, std::span<const Vec<D>>,         \
                            std::span<std::uint32_t>);
#define TREACLE_EACH_BUCKET(Backend)                                                                           \
  template void bucketCells(Context<Backend>&, std::span<const std::uint64_t>, std::span<const std::uint32_t>, \
                            int, std::span<std::uint64_t>);

}  // namespace treacle
