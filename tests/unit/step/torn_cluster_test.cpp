#include "support/torn_cluster.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

TEST(TornCluster, SinglePrecisionSeesTheSameImages) {
  const Case c = tornClusterCase();
  Scene<2> s;
  s.c = c;
  s.particles = tornClusterParticles(c);
  prepare(s);
  ASSERT_GT(countTorn(s.pairs()), 0);

  Case exact = c;
  exact.solver.precision = Precision::Double;
  Simulation<2> mixed(c, tornClusterParticles(c)), reference(exact, tornClusterParticles(exact));
  const StepReport found = mixed.advance(), expected = reference.advance();
  EXPECT_EQ(found.fallbacks, 0) << found.failures;
  EXPECT_NEAR(found.iterations, expected.iterations, 1);
  EXPECT_NEAR(found.diagnostics.kineticEnergy, expected.diagnostics.kineticEnergy,
              1e-8 * expected.diagnostics.kineticEnergy);  // measured: 1.5e-9
}

TEST(TornCluster, TheAssembledMatrixIsTheOperator) {
  Case c = tornClusterCase();
  c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  c.solver.krylov = KrylovKind::Cr;
  c.solver.precision = Precision::Double;
  Case stored = c;
  stored.solver.operatorKind = OperatorKind::Assembled;
  Simulation<2> free(c, tornClusterParticles(c)), assembled(stored, tornClusterParticles(c));
  const StepReport expected = free.advance(), found = assembled.advance();
  EXPECT_NEAR(found.iterations, expected.iterations, 1 + 0.01 * expected.iterations);  // measured: equal, 264
  EXPECT_NEAR(found.diagnostics.kineticEnergy, expected.diagnostics.kineticEnergy,
              1e-12 * expected.diagnostics.kineticEnergy);  // measured: 2e-14
}

}  // namespace
}  // namespace treacle::test
