#include "treacle/step/walls/distant_walls.hpp"

#include "support/passing_body.hpp"
#include "support/random_particles.hpp"

#include <omp.h>

namespace treacle::test {
namespace {

/// How many cells a and b are apart, by the nearest image: more than this number lies between them along some
/// axis.
template <int D>
double cellsBetween(const CellGrid<D>& grid, const Vec<D>& a, const Vec<D>& b) {
  const Vec<D> d = grid.difference(a, b);
  double most = 0;
  for (int k = 0; k < D; ++k) most = std::max(most, std::abs(d[k]) * grid.inverseEdge[k]);
  return most;
}

/// Walls of a few bodies at random places; those of every third body move, each in another way.
template <int D>
void checkChoice(std::uint32_t fluid, std::uint32_t walls, unsigned seed) {
  RandomParticles<D> r(fluid, walls, seed);
  Particles<D>& p = r.particles;
  r.grid = CellGrid<D>::make(Vec<D>{}, Vec<D>::filled(1), r.grid.periodic, 0.031);
  Case c;
  c.dimensions = D;
  c.bodies.resize(7);
  for (Body& body : c.bodies) body.kind = BodyKind::Wall;
  c.bodies[1].velocity[0] = 0.1;
  c.bodies[2].oscillation.period = 1;
  c.bodies[3].rotation.emplace();
  c.bodies[5].displacement[1] = TimeFunction{0, "t"};
  c.bodies[6].kind = BodyKind::Rigid;
  constexpr std::uint8_t moves[] = {1, 2, 3, 5, 6};
  for (std::uint32_t i = fluid; i < p.count; ++i) {
    p.velocity[i] = {};
    p.body[i] = static_cast<std::uint8_t>(i % 40 < 3 && p.position[i][0] < 0.3 ? moves[i % 5] : 4);
  }
  NearBlocks<D> near(c, r.grid);
  near.add(p);
  std::vector<std::uint32_t> moving;
  for (std::uint32_t i = 0; i < p.count; ++i)
    if (i < fluid || p.body[i] != 4) moving.push_back(i);
  std::uint32_t far = 0;
  for (std::uint32_t i = fluid; i < p.count; ++i) {
    if (!near.isFar(p, i)) continue;
    ++far;
    ASSERT_EQ(p.body[i], 4);
    for (const std::uint32_t j : moving) ASSERT_GT(cellsBetween(r.grid, p.position[i], p.position[j]), 4);
  }
  EXPECT_GT(far, walls / 20);
  const Particles<D> some = nearParticles(near, p);
  EXPECT_EQ(some.fluidCount, fluid);
  EXPECT_EQ(some.count, p.count - far);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    if (i >= fluid && near.isFar(p, i)) continue;
    ASSERT_EQ(some.id[next], i);
    ASSERT_EQ(some.position[next], p.position[i]);
    if (i >= fluid && !p.wallSurface.empty()) {
      ASSERT_EQ(some.wallSurface[next - fluid], p.wallSurface[i - fluid]);
    }
    ++next;
  }
}

TEST(NearBlocks, LeaveOutWallsAtRestThatAreFarFromAllThatMoves) {
  checkChoice<2>(10, 4000, 3);
  checkChoice<2>(0, 3001, 4);
  checkChoice<3>(30, 20000, 5);
}

/// The longer what moves needs to get there, the rarer walls are chosen.
TEST(NearBlocks, NothingThatMovesCrossesTheMarginBetweenItAndAWall) {
  Case c;
  const auto grid = CellGrid<2>::make({}, {2, 1}, {}, 0.05);
  const double edge = grid.edge[0];
  Particles<2> p;
  p.resize({1, 1});
  p.velocity[0] = p.velocity[1] = {};
  p.body[0] = p.body[1] = 0;
  double nearest = 2;  // of walls that are far
  for (int fluid = 0; fluid < 20; ++fluid)
    for (int wall = 0; wall < 40; ++wall) {
      p.position[0] = {(fluid + 0.5) * edge, 0.5};
      p.position[1] = {(wall + 0.5) * edge, 0.5};
      NearBlocks<2> near(c, grid);
      near.add(p);
      EXPECT_NEAR(near.margin(), 3 * edge, 0.05 * edge);
      if (near.isFar(p, 1)) nearest = std::min(nearest, std::abs(p.position[0][0] - p.position[1][0]));
    }
  EXPECT_NEAR(nearest, 5 * edge, 1e-9) << "four cells lie between, of which three are the margin";
}

TEST(NearBlocks, AParticleAtAPeriodicEndDoesNotRest) {
  RandomParticles<2> r(1, 2, 3);
  Case c;
  r.particles.velocity[1] = r.particles.velocity[2] = {};
  r.particles.position[1] = {1, 0.5};
  r.particles.position[2] = {0, 0.5};
  const NearBlocks<2> near(c, r.grid);
  EXPECT_FALSE(near.rests(r.particles, 1)) << "a step would put it to the other end";
  EXPECT_TRUE(near.rests(r.particles, 2));
}

TEST(DistantWalls, StepsAreThoseOfARunThatHasAllWalls) {
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate})
    expectSameAsWithAllWalls<2, Cpu>(passingBody(2, MethodKind::MphI, scheme), 32, 1);
  expectSameAsWithAllWalls<2, Cpu>(passingBody(2, MethodKind::Isph), 64, 1);
}

TEST(DistantWalls, StepsAreThoseOfARunThatHasAllWallsInSpace) {
  expectSameAsWithAllWalls<3, Cpu>(passingBody(3, MethodKind::MphI), 26, 4);
  expectSameAsWithAllWalls<3, Cpu>(passingBody(3, MethodKind::Isph), 56, 8);
}

TEST(DistantWalls, FollowStepsThatVaryAndParticlesThatAreShifted) {
  Case c = passingBody(2, MethodKind::MphI);
  c.time.automatic = true;
  c.time.step = 4e-3, c.time.least = 5e-4, c.time.end = 1;
  expectSameAsWithAllWalls<2, Cpu>(c, 100, 5);
  c = passingBody(2, MethodKind::Isph);
  c.time.courant = 0.9;
  c.method.isph.shifting = 0.05;
  expectSameAsWithAllWalls<2, Cpu>(c, 60, 5);
}

/// The state is continued while the fluid is in flight and walls have come and gone.
template <int D>
void checkContinuedWalls(const Case& c, int steps) {
  Simulation<D> whole(c, particlesOf<D>(c));
  for (int k = 0; k < steps; ++k) whole.advance();
  omp_set_num_threads(2);
  Simulation<D> first(c, particlesOf<D>(c));
  for (int k = 0; k < steps / 2; ++k) first.advance();
  Particles<D> state;
  first.copyParticles(state);
  EXPECT_LT(first.particles().count, state.count);
  Simulation<D> second(c, std::move(state), first.step(), first.time());
  for (int k = steps / 2; k < steps; ++k) second.advance();
  omp_set_num_threads(1);
  EXPECT_TRUE(StateById<D>::of(second) == StateById<D>::of(whole));
}

TEST(DistantWalls, AContinuedRunGivesTheSameBitsOnAnyNumberOfThreads) {
  checkContinuedWalls<2>(passingBody(2, MethodKind::MphI), 26);
  checkContinuedWalls<2>(passingBody(2, MethodKind::Isph), 52);
  checkContinuedWalls<3>(passingBody(3, MethodKind::MphI), 22);
}

/// What a run holds does not depend on how long its floor is.
TEST(DistantWalls, TakeNoFields) {
  const auto bytes = [](double length) {
    Case c = passingBody(2, MethodKind::MphI);
    c.bodies.pop_back();
    c.bodies[1].shape.max[0] = length * c.spacing;
    c.domain.max[0] = 2 * c.bodies[1].shape.max[0];
    Simulation<2> simulation(c, particlesOf<2>(c));
    simulation.advance();
    return std::pair(simulation.particles().wallCount(), simulation.numbers().wall);
  };
  const auto [held, all] = bytes(100);
  const auto [heldOfLonger, allOfLonger] = bytes(1000);
  EXPECT_EQ(heldOfLonger, held);
  EXPECT_EQ(allOfLonger, 10 * all);
}

}  // namespace
}  // namespace treacle::test
