#include "treacle/step/simulation.hpp"
#include "mpi/job.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/create.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

namespace treacle::test {
namespace {

struct Settings {
  const char* file;
  int steps;
  std::vector<std::string> keys;

  Case read() const { return readCase(std::string(TREACLE_CASES) + "/" + file, keys); }
};

template <int D>
Particles<D> made(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<D>(c, notes);
}

/// Of two sums or coordinates that may be zero; `scale`: what they are made of.
void expectNear(double a, double b, double scale, const char* what, std::int64_t step) {
  if (a == b) return;  // infinities, too
  EXPECT_NEAR(a, b, 1e-9 * scale) << what << " in step " << step;
}

void expectSame(const Case& c, const StepReport& a, const StepReport& b, bool alone) {
  if (alone) {
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy);
    EXPECT_EQ(a.diagnostics.frontX, b.diagnostics.frontX);
    return;
  }
  EXPECT_NEAR(a.iterations, b.iterations, 1) << "step " << b.step;
  const Diagnostics &p = a.diagnostics, &q = b.diagnostics;
  double extent = 0;
  for (int k = 0; k < c.dimensions; ++k) extent = std::max(extent, c.domain.max[k] - c.domain.min[k]);
  expectNear(p.kineticEnergy, q.kineticEnergy, q.kineticEnergy, "kinetic energy", b.step);
  expectNear(p.potentialEnergy, q.potentialEnergy, std::abs(q.potentialEnergy), "potential energy", b.step);
  expectNear(p.elasticEnergy, q.elasticEnergy, q.elasticEnergy + q.kineticEnergy, "elastic energy", b.step);
  expectNear(p.frontX, q.frontX, extent, "front", b.step);
  expectNear(p.top, q.top, extent, "top", b.step);
  expectNear(p.maxSpeed, q.maxSpeed, q.maxSpeed, "speed", b.step);
  EXPECT_EQ(p.insideWalls, q.insideWalls);
  ASSERT_EQ(a.balance.has_value(), b.balance.has_value());
  if (!a.balance) return;
  const double power = std::abs(q.gravityPower) + b.balance->shearDissipation;
  expectNear(a.balance->shearDissipation, b.balance->shearDissipation, power, "shear", b.step);
  expectNear(a.balance->bulkDissipation, b.balance->bulkDissipation, power, "bulk", b.step);
  expectNear(a.balance->elasticPower, b.balance->elasticPower, power, "elastic power", b.step);
  expectNear(a.balance->repulsionPower, b.balance->repulsionPower, power, "repulsion", b.step);
}

/// A simulation that the processes share against one that each of them makes for itself: iterations, energies and
/// extents of every step; all fields at the end.
template <int D>
void compare(const Settings& settings) {
  SCOPED_TRACE(settings.file);
  const Case c = settings.read();
  Simulation<D> shared(c, made<D>(c), 0, 0, &job());
  Simulation<D> alone(c, made<D>(c));
  for (int k = 0; k < settings.steps; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    expectSame(c, a, b, job().size() == 1);
    if (std::getenv("VERBOSE") && job().rank() == 0)
      printf("%d: %d %d  %.3g\n", k, a.iterations, b.iterations,
             a.diagnostics.kineticEnergy / b.diagnostics.kineticEnergy - 1);
  }
}

TEST(SharedSimulation, BlockJacobi) {
  compare<2>({"dam-break-2d.toml",
              5,
              {"solver.preconditioner=block-jacobi", "method.scheme=published", "solver.tolerance=1e-18"}});
}
TEST(SharedSimulation, BlockJacobiAccurate) {
  compare<2>({"dam-break-2d.toml", 5, {"solver.preconditioner=block-jacobi", "solver.tolerance=1e-18"}});
}
TEST(SharedSimulation, Published) { compare<2>({"dam-break-2d.toml", 20, {"method.scheme=published"}}); }
TEST(SharedSimulation, Accurate) { compare<2>({"dam-break-2d.toml", 20, {}}); }
TEST(SharedSimulation, AccurateDouble) { compare<2>({"dam-break-2d.toml", 20, {"solver.precision=double"}}); }
TEST(SharedSimulation, Balance) { compare<2>({"dam-break-2d.toml", 20, {"output.balance=true", "resolution=2"}}); }
TEST(SharedSimulation, Accurate3D) { compare<3>({"dam-break-3d.toml", 3, {}}); }

}  // namespace
}  // namespace treacle::test
