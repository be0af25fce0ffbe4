#pragma once

#include "snapshot.hpp"
#include "treacle/core/cuda.hpp"

#include <memory>
#include <vector>

namespace treacle {

/// Makes room for so many particles, in memory that a device copies to without a detour. Costs time where the
/// numbers change, otherwise nothing. Errors: std::bad_alloc.
template <int D>
void resizePinned(Snapshot<D>& snapshot, std::uint32_t fluid, std::uint32_t wall, std::uint32_t modes) {
  Particles<D>& p = snapshot.particles;
  if (snapshot.pinned && p.fluidCount == fluid && p.wallCount() == wall && p.modeCount() == modes) return;
  snapshot.pinned.reset();  // before the memory may be given up
  p.resize(fluid, wall, modes);
  auto pins = std::make_shared<std::vector<PinnedMemory>>();
  p.forEachField([&]<class T>(Buffer<T>& field) { pins->emplace_back(field.data(), field.size() * sizeof(T)); });
  snapshot.pinned = std::move(pins);
}

}  // namespace treacle
