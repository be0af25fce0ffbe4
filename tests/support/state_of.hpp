#pragma once

#include "treacle/step/run/simulation.hpp"

namespace treacle::test {

/// All particles of a simulation, walls that it does without included, on the host.
template <int D, class Backend>
Particles<D> stateOf(const Simulation<D, Backend>& simulation) {
  Particles<D> state;
  simulation.copyParticles(state);
  return state;
}

}  // namespace treacle::test
