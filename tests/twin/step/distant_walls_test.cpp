#include "support/gpu.hpp"
#include "support/passing_body.hpp"

namespace treacle::test {
namespace {

TEST(DistantWallsTwin, StepsAreThoseOfARunThatHasAllWalls) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate})
    expectSameAsWithAllWalls<2, Cuda>(passingBody(2, MethodKind::MphI, scheme), 32, 4);
  expectSameAsWithAllWalls<2, Cuda>(passingBody(2, MethodKind::Isph), 64, 4);
  expectSameAsWithAllWalls<3, Cuda>(passingBody(3, MethodKind::MphI), 26, 4);
  expectSameAsWithAllWalls<3, Cuda>(passingBody(3, MethodKind::Isph), 56, 4);
}

/// Both backends hold the same walls.
TEST(DistantWallsTwin, AreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  const Case c = passingBody(2, MethodKind::MphI);
  Simulation<2> cpu(c, particlesOf<2>(c));
  Simulation<2, Cuda> cuda(c, particlesOf<2>(c));
  for (int k = 0; k < 24; ++k) {
    EXPECT_EQ(cuda.particles().count, cpu.particles().count) << "step " << k;
    cpu.advance(), cuda.advance();
  }
}

}  // namespace
}  // namespace treacle::test
