#pragma once

#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

namespace treacle::test {

/// A body on a floor, stretched as at the end of a collapse; with smoothers too weak for it, so that M A has modes
/// far above the others from the start.
struct StretchedBody {
  Case c = sceneCase(2, false);
  Particles<2> particles;

  StretchedBody() {
    c.domain.max[0] = c.domain.max[1] = 60e-3;
    c.gravity[1] = -10;
    c.solver.projected = {4, 2, 1, 100};
    const double l = c.spacing;
    particles = jitteredLattice<2>(
        c, 0.1, 1,
        [&](const Vec<2>& x) { return x[1] >= 4 * l && x[1] < 34 * l && x[0] > 5 * l && x[0] < 35 * l; },
        [&](const Vec<2>& x) { return x[1] < 4 * l; });
    for (std::uint32_t i = 0; i < particles.count; ++i) particles.velocity[i] = {};
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i) {
      Vec<2>& x = particles.position[i];
      x[0] = 5 * l + (x[0] - 5 * l) * 1.4, x[1] = 4 * l + (x[1] - 4 * l) / 1.4;
    }
  }

  template <class Backend = Cpu>
  Simulation<2, Backend> start(int deflation) {
    c.solver.deflation = deflation;
    return Simulation<2, Backend>(c, std::move(particles));
  }
};

}  // namespace treacle::test
