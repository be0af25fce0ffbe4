#pragma once

#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace treacle::test {

/// A block of fluid in flight that comes down on a long floor, and far from it a plate that goes along the floor:
/// from both most of the floor is far, at first all of it from the fluid. In 3D it is periodic across.
inline Case passingBody(int dimensions, MethodKind kind, SchemeKind scheme = SchemeKind::Accurate) {
  const double l = 1e-3;
  Case c;
  c.dimensions = dimensions;
  c.spacing = l;
  c.time = {1e-3, 1};
  c.method = defaultMethod(scheme);
  c.method.kind = kind;
  c.watch.density = c.watch.insideWalls = 1;  // the impact is a hard one
  c.materials.push_back({"syrup", 1000, 0.1, 1e3, 1e5});
  if (kind == MethodKind::Isph) {
    c.materials[0] = {"water", 1000, 1e-3, 0, 0};
    c.solver.preconditioner = PreconditionerKind::HatMultigrid;
    c.solver.firstGuess = FirstGuess::Last;
    c.time.step = 5e-4;
  }
  const int up = dimensions - 1;
  const double across = 21 * l;
  const auto box = [&](const char* name, BodyKind type, Vec<3> min, Vec<3> max, const Vec<3>& velocity) {
    const double margin = type == BodyKind::Fluid ? 8 * l : 0;
    if (dimensions == 3) min = {min[0], margin, min[1]}, max = {max[0], across - margin, max[1]};
    Body body;
    body.name = name;
    body.kind = type;
    body.shape.min = min, body.shape.max = max;
    body.velocity[0] = velocity[0], body.velocity[up] = velocity[1];
    c.bodies.push_back(body);
  };
  box("block", BodyKind::Fluid, {48 * l, 44 * l}, {53 * l, 49 * l}, {2, -1.2});
  box("floor", BodyKind::Wall, {0, 6 * l}, {250 * l, 14 * l}, {});
  box("plate", BodyKind::Wall, {240 * l, 14 * l}, {244 * l, 18 * l}, {-0.25, 0});
  c.domain.max = {300 * l, 64 * l, 0};
  if (dimensions == 3) c.domain.max = {300 * l, across, 64 * l}, c.domain.periodic[1] = true;
  return c;
}

/// The same case, whose walls are all there all the time: they oscillate, by nothing.
inline Case withAllWalls(Case c) {
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation.period = 1;
  return c;
}

template <int D>
Particles<D> particlesOf(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<D>(c, notes);
}

/// All particles with all their fields, in the order of their ids.
template <int D>
struct StateById {
  std::vector<Vec<D>> position, velocity;
  std::vector<double> pressure, numberDensity;
  std::vector<std::uint8_t> material, body;
  std::vector<WallSurface<D>> surface;

  explicit StateById(const Particles<D>& p) {
    std::vector<std::uint32_t> place(p.count, p.count);
    for (std::uint32_t i = 0; i < p.count; ++i) place.at(p.id[i]) = i;
    for (const std::uint32_t i : place) {
      if (i == p.count) ADD_FAILURE() << "a particle is missing";
      position.push_back(p.position[i]), velocity.push_back(p.velocity[i]);
      pressure.push_back(p.pressure[i]), numberDensity.push_back(p.numberDensity[i]);
      material.push_back(p.material[i]), body.push_back(p.body[i]);
      if (i >= p.fluidCount && !p.wallSurface.empty()) surface.push_back(p.wallSurface[i - p.fluidCount]);
    }
  }
  template <class Backend>
  static StateById of(const Simulation<D, Backend>& simulation) {
    Particles<D> p;
    simulation.copyParticles(p);
    return StateById(p);
  }

  bool operator==(const StateById&) const = default;
};

/// Of the walls that a simulation holds.
template <int D, class Backend>
std::vector<std::uint32_t> wallIds(const Simulation<D, Backend>& simulation) {
  Context<Backend> context;
  Particles<D> walls;
  copyWallsToHost(context, simulation.particles(), walls);
  return {walls.id.begin(), walls.id.end()};
}

/// Steps of a run give the same bits as those of one that has all walls, and walls come and go.
template <int D, class Backend>
void expectSameAsWithAllWalls(const Case& c, int steps, int compareEvery) {
  Simulation<D, Backend> some(c, particlesOf<D>(c));
  const Case whole = withAllWalls(c);
  Simulation<D, Backend> all(whole, particlesOf<D>(whole));
  const std::uint32_t walls = all.particles().wallCount();
  ASSERT_EQ(some.numbers(), all.numbers());
  ASSERT_EQ(all.numbers().wall, walls);
  const std::uint32_t start = some.particles().wallCount();
  EXPECT_LT(start, 0.6 * walls);
  std::size_t ever = start, last = start;
  std::vector<bool> held(some.numbers().wall);  // at any time
  for (int k = 1; k <= steps; ++k) {
    const StepReport a = some.advance(), b = all.advance();
    ASSERT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy) << "step " << k;
    ASSERT_EQ(a.iterations, b.iterations) << "step " << k;
    ASSERT_EQ(a.rejected, b.rejected) << "step " << k;
    const std::vector<std::uint32_t> ids = wallIds(some);
    for (const std::uint32_t id : ids) held[id - some.numbers().fluid] = true;
    ever = std::ranges::count(held, true), last = ids.size();
    if (k % compareEvery == 0 || k == steps) {
      ASSERT_TRUE(StateById<D>::of(some) == StateById<D>::of(all)) << "step " << k;
      ASSERT_EQ(some.numbers(), all.numbers());
    }
  }
  EXPECT_GT(ever, start) << "walls have been taken in";
  EXPECT_LT(last, ever) << "and left out again";
}

}  // namespace treacle::test
