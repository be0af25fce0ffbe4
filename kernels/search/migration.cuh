#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

// Particles on a device that come and go, and the room for them.

/// Fluid goes to its new owners with all its fields, and comes from its old ones. In the order of
/// workspace.sortedIndex the particles [begins[r], begins[r + 1]) belong to rank r; `arriving`: how many come from
/// each rank. Kept ones stay in that order, before those that come, in the order of ranks. Walls stay; ghosts are
/// gone. Collective.
template <int D>
void exchangeFluid(Context<Cuda>& context, Particles<D, Cuda>& particles, SortWorkspace<Cuda>& workspace,
                   std::span<const std::uint32_t> begins, std::span<const std::uint32_t> arriving);

/// Makes the own fluid those particles `index`[0, kept), device memory, in this order, and behind them `come`
/// others: `arrived` has their fields, one after the other as forEachFieldOfFluid goes over them, each padded().
/// Walls stay; ghosts are gone. `room`: takes one field at a time.
template <int D>
void joinFluid(Context<Cuda>& context, Particles<D, Cuda>& particles, const std::uint32_t* index,
               std::uint32_t kept, const std::byte* arrived, std::uint32_t come, Buffer<std::byte, Cuda>& room);

/// Brings own fluid and walls into the order of workspace.sortedIndex, which has those of the fluid first, with
/// room for so many ghosts between them.
template <int D>
void arrange(Context<Cuda>& context, Particles<D, Cuda>& particles, SortWorkspace<Cuda>& workspace,
             std::uint32_t ghosts);

}  // namespace treacle
