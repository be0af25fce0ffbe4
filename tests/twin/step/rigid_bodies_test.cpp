#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Calls check(a, b) with the second body of a case after each step, on the CPU and the device.
template <int D, class Check>
void compareBodies(Case c, int steps, Check&& check) {
  c.solver.tolerance = 1e-16;
  c.solver.deflation = 0;
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int k = 0; k < steps && !::testing::Test::HasFatalFailure(); ++k) {
    const RigidBody a = cpu.advance().rigid[1], b = cuda.advance().rigid[1];
    SCOPED_TRACE(k);
    check(a, b);
  }
}

template <int D>
void compareBlocks(Case c, int steps = 8) {
  c.gravity[1] = -10;
  c.bodies[1].rigid.angularVelocity = {0, 0, 5};
  compareBodies<D>(c, steps, [&](const RigidBody& a, const RigidBody& b) {
    ASSERT_LE(norm(a.velocity - b.velocity), 1e-5 * norm(a.velocity));
    ASSERT_LE(norm(a.spin - b.spin), 1e-4 * (norm(a.spin) + 1));
    ASSERT_LE(norm(a.center - b.center), 1e-5 * c.spacing);
  });
}

/// Until it has hit the floor with a corner and its side.
template <int D>
void compareFall(const Case& c) {
  compareBodies<D>(c, 25, [&](const RigidBody& a, const RigidBody& b) {
    ASSERT_LE(norm(a.velocity - b.velocity), 1e-3 * 0.6);
    ASSERT_LE(norm(a.center - b.center), 1e-3 * c.spacing);
  });
}

TEST(RigidBodiesTwin, TouchAsOnTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareFall<2>(fallingBlockCase(2, 30));
  compareFall<3>(fallingBlockCase(3, 30));
  compareFall<2>(withIsph(fallingBlockCase(2, 30), 5));
  compareFall<2>(withDistantFluid(fallingBlockCase(2, 30)));
}

TEST(RigidBodiesTwin, MoveAsOnTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareBlocks<2>(blockCase(2, 300));
  compareBlocks<2>(blockCase(2, 7000));
  compareBlocks<3>(blockCase(3, 1));
}

TEST(RigidBodiesTwin, MoveAsOnTheCpuWithIsph) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const double viscosity : {1e-3, 5.0}) {
    compareBlocks<2>(withIsph(blockCase(2, 300), viscosity));
    compareBlocks<3>(withIsph(blockCase(3, 1), viscosity), 5);  // then what is rounded grows twentyfold in a step
  }
}

}  // namespace
}  // namespace treacle::test
