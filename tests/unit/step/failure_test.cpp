#include "support/scene.hpp"
#include "treacle/core/error.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

std::string failureOf(Simulation<2>& simulation) {
  try {
    for (int k = 0; k < 50; ++k) simulation.advance();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no failure";
}

TEST(Failure, OfTheSolverKeepsTheLastGoodState) {
  Scene<2> s = makeScene<2>();
  s.c.gravity[1] = -10;
  s.c.solver.maxIterations = 2;
  std::vector<Vec<2>> before(s.particles.count);
  for (std::uint32_t i = 0; i < s.particles.count; ++i) before[s.particles.id[i]] = s.particles.position[i];
  Simulation<2> simulation(s.c, std::move(s.particles));
  const std::string message = failureOf(simulation);
  EXPECT_NE(message.find("did not converge"), std::string::npos) << message;
  EXPECT_NE(message.find("after 6 iterations"), std::string::npos) << message;
  for (const char* stage : {"projected-multigrid, mixed", "projected-multigrid, double"})
    EXPECT_NE(message.find(stage), std::string::npos) << message;
  EXPECT_EQ(simulation.step(), 0);
  const Particles<2>& p = simulation.particles();
  for (std::uint32_t i = 0; i < p.count; ++i) ASSERT_EQ(p.position[i], before[p.id[i]]);
}

TEST(Failure, NamesAParticleThatLeavesAnOpenDomain) {
  Scene<2> s = makeScene<2>({.walls = Walls::None});
  s.c.gravity[1] = -10;
  s.c.domain.periodic[1] = false;
  s.c.time.step = 5e-3;
  for (Material& m : s.c.materials) m.bulkModulus = 1e4;
  Simulation<2> simulation(s.c, std::move(s.particles));
  const std::string message = failureOf(simulation);
  EXPECT_NE(message.find("fluid particle"), std::string::npos) << message;
  EXPECT_NE(message.find("left the domain"), std::string::npos) << message;
  EXPECT_GT(simulation.step(), 0);
  for (std::uint32_t i = 0; i < simulation.particles().fluidCount; ++i)
    ASSERT_GE(simulation.particles().position[i][1], 0);
}

TEST(Failure, NamesAValueThatIsNotFinite) {
  Scene<2> s = makeScene<2>();
  s.particles.velocity[5][0] = NAN;
  const std::uint32_t id = s.particles.id[5];
  Simulation<2> simulation(s.c, std::move(s.particles));
  const std::string message = failureOf(simulation);
  EXPECT_NE(message.find("not finite"), std::string::npos) << message;
  EXPECT_NE(message.find("particle " + std::to_string(id)), std::string::npos) << message;
}

TEST(Failure, EndsWhereTheTimeNoLongerAdvances) {
  Scene<2> s = makeScene<2>();
  s.particles.velocity[5][0] = 1e60;
  s.c.time.courant = 0.1;
  Simulation<2> simulation(s.c, std::move(s.particles), 1, 1.0);
  const std::string message = failureOf(simulation);
  EXPECT_NE(message.find("the time no longer advances"), std::string::npos) << message;
  EXPECT_EQ(simulation.step(), 1);
}

}  // namespace
}  // namespace treacle::test
