#include "treacle/linear/hat_nodes.hpp"

#include "support/gpu.hpp"
#include "support/hats.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace treacle::test {
namespace {

template <class T>
void expectSame(const Context<Cuda>& context, const Buffer<T, Cuda>& device, const Buffer<T>& host) {
  const Buffer<T> found = copyToHost(context, device);
  ASSERT_EQ(found.size(), host.size());
  EXPECT_TRUE(std::equal(host.begin(), host.end(), found.begin()));
}

/// Nodes, pattern and Galerkin operators on both sides, level after level.
template <int D, int B>
void checkLevels(Context<Cuda>& context, const HatCase<D>& c) {
  SCOPED_TRACE(testing::Message() << D << "-D, " << c.name << ", " << c.active.size() << " points, " << B
                                  << " numbers each");
  Context<Cpu> host;
  HatProblem<D, B> problem(c);
  HatNodes<D> nodes = std::move(problem.nodes);
  BlockCsr<B> a = std::move(problem.a);
  HatNodes<D, Cuda> deviceNodes;
  BlockCsr<B, double, Cuda> deviceA;
  numberNodes<D>(context, c.lattice, copyToDevice<std::uint8_t>(context, c.active), deviceNodes);
  hatPattern<D>(context, deviceNodes, deviceA, problem.reach);
  for (int level = 0; level < 5; ++level) {
    SCOPED_TRACE(testing::Message() << "level " << level);
    EXPECT_EQ(deviceNodes.lattice.count, nodes.lattice.count);
    expectSame(context, deviceNodes.nodeAt, nodes.nodeAt);
    expectSame(context, deviceNodes.point, nodes.point);
    expectSame(context, deviceA.rowStart, a.rowStart);
    expectSame(context, deviceA.column, a.column);
    if (level == 0) deviceA = onDevice(context, a);  // so far a pattern only
    EXPECT_LE(matrixDifference(onHost(context, deviceA), a), operatorTolerance);
    if (testing::Test::HasFailure()) return;

    HatNodes<D> coarse;
    HatNodes<D, Cuda> deviceCoarse;
    BlockCsr<B> coarseA;
    BlockCsr<B, double, Cuda> deviceCoarseA;
    coarserNodes<D>(host, nodes, coarse);
    coarserNodes<D>(context, deviceNodes, deviceCoarse);
    coarsenHats<D>(host, nodes, a, coarse, coarseA, problem.reach);
    coarsenHats<D>(context, deviceNodes, deviceA, deviceCoarse, deviceCoarseA, problem.reach);
    std::swap(nodes, coarse);
    std::swap(a, coarseA);
    std::swap(deviceNodes, deviceCoarse);
    std::swap(deviceA, deviceCoarseA);
  }
}

TEST(HatNodesTwin, LevelsAreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  for (int size : {4, 5, 13, 110})
    for (const HatCase<2>& c : hatCases<2>(size)) {
      checkLevels<2, 1>(context, c);
      checkLevels<2, 2>(context, c);
    }
  for (int size : {4, 7, 24})
    for (const HatCase<3>& c : hatCases<3>(size)) {
      checkLevels<3, 1>(context, c);
      checkLevels<3, 3>(context, c);
    }
}

}  // namespace
}  // namespace treacle::test
