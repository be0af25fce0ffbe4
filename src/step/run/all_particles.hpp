#pragma once

#include "flow_state.hpp"
#include "gather_particles.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/step/walls/distant_walls.hpp"

#include <type_traits>

namespace treacle {

/// The numbers of all processes that share the state, with the walls that the simulation does not hold.
template <int D, class Backend>
ParticleNumbers numbersOfAll(const FlowState<D, Backend>& state, const DistantWalls<D>& distant) {
  ParticleNumbers all = state.particles.numbers();
  all.fluid = state.fluidOfAll, all.ghosts = 0;
  all.wall += distant.count();
  all.surfaces += distant.surfaceCount();
  return all;
}

/// All fields of these. Of several processes the first gets them; the others' `host` is not touched. Collective.
/// Errors: std::bad_alloc.
template <int D, class Backend>
void copyAllParticles(const FlowState<D, Backend>& state, const DistantWalls<D>& distant, Particles<D>& host) {
  const ParticleNumbers all = numbersOfAll(state, distant);
  const Communicator* processes = state.context.communicator;
  if (!processes) {
    host.resize(all);
    copyFieldsToHost(state.context, state.particles, host);
    return distant.copyTo(host);
  }
  const auto gather = [&](const Particles<D>& own) {
    gatherParticles(*processes, *state.context.halo, own, all, host);
  };
  if constexpr (std::is_same_v<Backend, Cpu>) {
    gather(state.particles);
  } else {
    Particles<D> own;
    copyToHost(state.context, state.particles, own);
    gather(own);
  }
  distant.copyTo(host);
}

}  // namespace treacle
