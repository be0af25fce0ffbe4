#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/particles.hpp"

namespace treacle {

/// All particles of all processes at the first of them, as a simulation that is alone would have them: fluid
/// sorted by cell, walls in the order of their ids. There is room for as many as `all` says; walls that no process
/// holds are to follow. Collective. Errors: std::bad_alloc.
template <int D>
void gatherParticles(const Communicator& processes, const HaloCounts& halo, const Particles<D>& own,
                     ParticleNumbers all, Particles<D>& whole);

}  // namespace treacle
