#pragma once

#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace treacle::test {

enum class WallsMove { Not, Apart, Oscillating };

/// A jittered block of two fluids, in motion under oblique gravity, in the corner of a floor and a side wall, two
/// bodies that touch; nothing is periodic. The ids are the places in `particles`. `finer`: so many particles along
/// each millimetre. Those of the accurate scheme are
/// jittered so far that some repel each other.
template <int D>
struct LoadedWalls {
  Case c;
  Particles<D> particles;

  explicit LoadedWalls(WallsMove how, int finer = 1, SchemeKind scheme = SchemeKind::Published)
      : c(sceneCase(D, true, scheme)) {
    const double l = c.spacing;
    c.spacing /= finer;
    c.domain.periodic = {};
    c.gravity[0] = 3;
    c.gravity[D - 1] = -10;
    c.solver.tolerance = 1e-24;
    c.output.balance = true;
    const int up = D - 1;
    const double edge = c.domain.max[0] - l, height = (D == 2 ? 16 : 12) * l;
    const auto inside = [=](const Vec<D>& x) {
      return std::all_of(x.v, x.v + D, [=](double a) { return a > l && a < edge; });
    };
    particles = jitteredLattice<D>(
        c, scheme == SchemeKind::Accurate ? 0.4 : 0.2, 5,
        [=](const Vec<D>& x) {
          return x[0] > 5 * l && x[0] < (D == 2 ? 12 : 9) * l && x[up] > 5 * l && x[up] < (D == 2 ? 13 : 9) * l &&
                 (D == 2 || (x[1] > 3 * l && x[1] < 8 * l));
        },
        [=](const Vec<D>& x) { return inside(x) && x[up] < height && (x[up] < 5 * l || x[0] < 5 * l); });
    knowSurface(c, 5 * l, particles);
    c.bodies.resize(3);
    c.bodies[0].name = "block";
    c.bodies[1].name = "floor";
    c.bodies[2].name = "side";
    c.bodies[1].kind = c.bodies[2].kind = BodyKind::Wall;
    if (how != WallsMove::Not) {
      c.bodies[1].velocity[0] = 0.05;
      c.bodies[2].velocity[up] = -0.03;
    }
    if (how == WallsMove::Oscillating) {
      c.bodies[1].oscillation = {{2e-4, 1e-4, 0}, 0.02, 0.3};
      c.time.courant = 0.1;
    }
    for (std::uint32_t i = particles.fluidCount; i < particles.count; ++i) {
      particles.body[i] = particles.position[i][up] < 5 * l ? 1 : 2;
      particles.velocity[i] = resized<D>(c.bodies[particles.body[i]].velocity);
    }
  }

  Particles<D> copy() const {
    Particles<D> p;
    p.resize(particles.numbers());
    forEachFieldOf([](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); }, particles,
                   p);
    return p;
  }

  template <class Backend>
  Simulation<D, Backend> simulation() const {
    return Simulation<D, Backend>(c, copy());
  }
};

/// Where the energy of a step has come from and gone to [J].
struct StepEnergy {
  double gained, fallen;  // kinetic energy, and what was potential energy
  double lost, given;     // by dissipation; by walls, compression and height

  StepEnergy(const Diagnostics& before, const StepReport& report)
      : gained(report.diagnostics.kineticEnergy - before.kineticEnergy),
        fallen(before.potentialEnergy - report.diagnostics.potentialEnergy) {
    const Balance& b = *report.balance;
    const double dt = report.velocityStep;
    lost = dt * (b.inertialLoss + b.shearDissipation + b.bulkDissipation);
    given = dt * (b.elasticPower + b.wallPower + b.repulsionPower + b.surfacePower + b.buoyancyPower +
                  report.diagnostics.gravityPower);
  }
  double scale() const { return std::abs(gained) + lost + std::abs(given); }
};

}  // namespace treacle::test
