#include "support/gpu.hpp"
#include "support/loaded_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace treacle::test {
namespace {

/// Velocities of the two differ by the residuals of their solves; balances are sums of their squares. `arm`: how
/// far walls reach from where their torques are taken [m].
void expectCloseBalance(const Balance& expected, const Balance& found, double arm) {
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-8 * std::abs(a); };
  EXPECT_PRED2(close, expected.shearDissipation, found.shearDissipation);
  EXPECT_PRED2(close, expected.bulkDissipation, found.bulkDissipation);
  EXPECT_PRED2(close, expected.inertialLoss, found.inertialLoss);
  EXPECT_PRED2(close, expected.elasticPower, found.elasticPower);
  EXPECT_PRED2(close, expected.elasticEnergy, found.elasticEnergy);
  EXPECT_PRED2(close, expected.wallPower, found.wallPower);
  EXPECT_PRED2(close, expected.repulsionPower, found.repulsionPower);
  EXPECT_PRED2(close, expected.shiftPower, found.shiftPower);
  EXPECT_PRED2(close, expected.buoyancyPower, found.buoyancyPower);
  ASSERT_EQ(expected.walls.size(), found.walls.size());
  for (std::size_t k = 0; k < expected.walls.size(); ++k) {
    const WallLoad &a = expected.walls[k], &b = found.walls[k];
    EXPECT_LE(norm(a.force - b.force), 1e-8 * norm(a.force));
    // What is summed is arms times forces: the pressures on both halves of a wall may leave next to nothing of it.
    EXPECT_LE(norm(a.torque - b.torque), 1e-8 * std::max(norm(a.torque), arm * norm(a.force)));
  }
}

bool sameBalance(const Balance& a, const Balance& b) {
  bool same = a.shearDissipation == b.shearDissipation && a.bulkDissipation == b.bulkDissipation &&
              a.inertialLoss == b.inertialLoss && a.elasticPower == b.elasticPower &&
              a.elasticEnergy == b.elasticEnergy && a.wallPower == b.wallPower && a.walls.size() == b.walls.size();
  for (std::size_t k = 0; same && k < a.walls.size(); ++k)
    same = a.walls[k].force == b.walls[k].force && a.walls[k].torque == b.walls[k].torque;
  return same;
}

/// `radii`: h_p and h_v in spacings.
template <int D>
void compare(WallsMove how, NeighbourKind neighbours, const std::array<double, 2>& radii,
             SchemeKind scheme = SchemeKind::Published) {
  LoadedWalls<D> start(how, 1, scheme);
  start.c.solver.krylov = KrylovKind::Cr;
  start.c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  start.c.solver.precision = Precision::Double;
  start.c.solver.neighbours = neighbours;
  start.c.method.pressureRadius = radii[0];
  start.c.method.viscosityRadius = radii[1];
  auto cpu = start.template simulation<Cpu>();
  auto cuda = start.template simulation<Cuda>(), again = start.template simulation<Cuda>();
  const double arm = norm(start.c.domain.max);
  for (int step = 0; step < 3; ++step) {
    const Balance found = *cuda.advance().balance;
    expectCloseBalance(*cpu.advance().balance, found, arm);
    EXPECT_TRUE(sameBalance(found, *again.advance().balance));
  }
}

template <int D>
void compareAll(NeighbourKind neighbours) {
  compare<D>(WallsMove::Not, neighbours, {1.75, 3.5});
  compare<D>(WallsMove::Oscillating, neighbours, {1.75, 3.5});
  compare<D>(WallsMove::Apart, neighbours, {2.2, 1.9});
  compare<D>(WallsMove::Apart, neighbours, {3, 3.5}, SchemeKind::Accurate);
}

TEST(BalanceTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareAll<2>(NeighbourKind::Lists);
  compareAll<3>(NeighbourKind::Lists);
}

TEST(BalanceTwin, FromCellRangesEqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareAll<2>(NeighbourKind::Ranges);
  compareAll<3>(NeighbourKind::Ranges);
}

}  // namespace
}  // namespace treacle::test
