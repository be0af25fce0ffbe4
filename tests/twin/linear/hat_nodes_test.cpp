#include "treacle/linear/hat_nodes.hpp"

#include "support/gpu.hpp"
#include "support/hats.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"

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

/// The weights are those of the CPU, and the products of sparse matrices the operator `expected`.
template <int D, int B>
void checkProducts(Context<Cuda>& context, GalerkinSpgemm<B>& spgemm, const HatNodes<D>& fine,
                   const HatNodes<D>& coarse, const HatNodes<D, Cuda>& deviceFine,
                   const HatNodes<D, Cuda>& deviceCoarse, const BlockCsr<B, double, Cuda>& a,
                   const BlockCsr<B>& expected) {
  Context<Cpu> host;
  Prolongation<> p;
  Prolongation<Cuda> deviceP;
  hatProlongation<D>(host, fine, coarse, p);
  hatProlongation<D>(context, deviceFine, deviceCoarse, deviceP);
  EXPECT_EQ(deviceP.coarseRows, p.coarseRows);
  EXPECT_EQ((matrixDifference<1, double>(onHost<1, double>(context, deviceP), p)), 0);
  BlockCsr<B, double, Cuda> product;
  spgemm.compute(context, a, deviceP, product);
  const BlockCsr<B> onCpu = onHost(context, product);
  EXPECT_LE(valueDifference(onCpu, expected), operatorTolerance);
  for (std::uint32_t i = 0; i < onCpu.rows(); ++i) {
    const auto begin = onCpu.column.begin() + onCpu.rowStart[i],
               end = onCpu.column.begin() + onCpu.rowStart[i + 1];
    ASSERT_TRUE(std::find(begin, end, i) != end) << "no diagonal";
  }
}

/// Nodes, pattern and Galerkin operators on both sides, level after level.
template <int D, int B>
void checkLevels(Context<Cuda>& context, GalerkinSpgemm<B>& spgemm, const HatCase<D>& c) {
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
    checkProducts<D, B>(context, spgemm, nodes, coarse, deviceNodes, deviceCoarse, deviceA, coarseA);
    std::swap(nodes, coarse);
    std::swap(a, coarseA);
    std::swap(deviceNodes, deviceCoarse);
    std::swap(deviceA, deviceCoarseA);
  }
}

TEST(HatNodesTwin, LevelsAreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  GalerkinSpgemm<1> ofOne;  // what they keep must fit the next system too
  GalerkinSpgemm<2> ofTwo;
  GalerkinSpgemm<3> ofThree;
  for (int size : {4, 5, 13, 110})
    for (const HatCase<2>& c : hatCases<2>(size)) {
      checkLevels<2, 1>(context, ofOne, c);
      checkLevels<2, 2>(context, ofTwo, c);
    }
  for (int size : {4, 7, 24})
    for (const HatCase<3>& c : hatCases<3>(size)) {
      checkLevels<3, 1>(context, ofOne, c);
      checkLevels<3, 3>(context, ofThree, c);
    }
}

}  // namespace
}  // namespace treacle::test
