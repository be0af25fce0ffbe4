#pragma once

#include "snapshot.hpp"
#include "treacle/core/cuda.hpp"

#include <memory>
#include <vector>

namespace treacle {

/// Makes room for so many particles and modes, in memory that a device copies to without a detour. Costs time
/// where the numbers change, otherwise nothing. Errors: std::bad_alloc.
inline void resizePinned(Snapshot& snapshot, int dimensions, ParticleNumbers numbers) {
  AnyParticles& particles = snapshot.particles;
  if (snapshot.pinned && particles.numbers() == numbers) return;
  snapshot.pinned.reset();  // before the memory may be given up
  if (particles.dimensions() != dimensions) particles = AnyParticles(dimensions);
  particles.visit([&](auto& p) {
    p.resize(numbers);
    auto pins = std::make_shared<std::vector<PinnedMemory>>();
    p.forEachField([&]<class T>(Buffer<T>& field) { pins->emplace_back(field.data(), field.size() * sizeof(T)); });
    snapshot.pinned = std::move(pins);
  });
}

}  // namespace treacle
