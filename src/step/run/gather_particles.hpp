#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/particles/particles.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace treacle {

/// The parts of all processes, in the order of ranks, to the places from `to` on at the first one. Collective.
template <class T>
void collectTo(const Communicator& processes, std::span<const T> part, T* to) {
  const std::vector<T> parts = processes.collect(part);
  std::copy(parts.begin(), parts.end(), to);
}

/// All particles of all processes at the first of them, as a simulation that is alone would have them: fluid
/// sorted by cell, walls in the order of their ids. There is room for as many as `all` says; walls that no process
/// holds are to follow. Collective. Errors: std::bad_alloc.
template <int D>
void gatherParticles(const Communicator& processes, const HaloCounts& halo, const Particles<D>& own,
                     ParticleNumbers all, Particles<D>& whole);

}  // namespace treacle
