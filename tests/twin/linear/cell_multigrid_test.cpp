#include "treacle/linear/cell_multigrid.hpp"

#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/pressure_column.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/krylov.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace treacle::test {
namespace {

/// One pressure equation on both sides.
struct Twins {
  Context<Cpu> host;
  Context<Cuda>& context;
  PressureColumn column;
  BucketLevels<> levels;
  BlockCsr<1, double, Cuda> a;
  std::vector<Buffer<std::uint32_t, Cuda>> cells;

  Twins(Context<Cuda>& c, Vec<3, int> size) : context(c), column(size), levels(column.levels()) {
    a = onDevice(context, column.a);
    for (const auto& begin : levels.begin) cells.push_back(copyToDevice<std::uint32_t>(context, begin));
  }

  std::vector<double> onCpu(int m, int n) {
    CellMultigrid<double> multigrid;
    multigrid.setup(host, column.a, levels.begin, m, n);
    std::vector<double> z(column.count());
    multigrid.apply(host, column.rightHandSide(), z);
    return z;
  }

  template <class T>
  Buffer<double> apply(CellMultigrid<T, Cuda>& multigrid) {
    const std::vector<double> b = column.rightHandSide();
    const auto r = copyToDevice<double>(context, b);
    auto z = copyToDevice<double>(context, b);  // what is there before must not count
    multigrid.apply(context, r, z);
    return copyToHost(context, z);
  }

  /// `multigrid` is set up anew for each case.
  template <class T>
  void check(CellMultigrid<T, Cuda>& multigrid, int m, int n, double tolerance) {
    SCOPED_TRACE(testing::Message() << column.count() << " particles, MGCG(" << m << ", " << n << ")"
                                    << (sizeof(T) == 4 ? ", single precision" : ""));
    multigrid.setup(context, a, cells, m, n);
    const Buffer<double> z = apply(multigrid), again = apply(multigrid);
    const std::vector<double> expected = onCpu(m, n);
    EXPECT_LE(relativeDifference<double>(z, expected), tolerance);
    for (std::uint32_t i = 0; i < column.count(); ++i) ASSERT_TRUE(column.unknown[i] || z[i] == 0);
    ASSERT_TRUE(z.size() == 0 || std::memcmp(z.data(), again.data(), z.span().size_bytes()) == 0)
        << "not the same bits";
  }

  /// Conjugate gradients to a relative residual of 1e-10 in memory of `backend`; x comes out on the host.
  template <class Backend>
  SolveReport solve(Context<Backend>& backend, const BlockCsr<1, double, Backend>& matrix,
                    std::span<const Buffer<std::uint32_t, Backend>> members, std::span<const double> b,
                    std::span<double> x) {
    CellMultigrid<double, Backend> multigrid;
    multigrid.setup(backend, matrix, members, 0, 4);
    const auto multiplyA = [&](std::span<const double> in, std::span<double> out) {
      multiply<1, double>(backend, matrix, {reinterpret_cast<const Vec<1>*>(in.data()), in.size()},
                          {reinterpret_cast<Vec<1>*>(out.data()), out.size()});
    };
    const auto m = [&](std::span<const double> r, std::span<double> z) { multigrid.apply(backend, r, z); };
    KrylovWorkspace<Backend> workspace;
    return conjugateGradient(backend, {multiplyA, m, b, x}, {1e-20, 1000}, workspace);
  }

  /// On the device the iteration is a graph: the preconditioner must work in one.
  void checkSolve() {
    const std::vector<double> b = column.rightHandSide();
    std::vector<double> x(b.size());
    const auto bOnDevice = copyToDevice<double>(context, b);
    auto xOnDevice = copyToDevice<double>(context, x);
    const SolveReport expected = solve<Cpu>(host, column.a, levels.begin, b, x);
    const SolveReport report = solve<Cuda>(context, a, cells, bOnDevice, xOnDevice);
    EXPECT_EQ(report.status, SolveStatus::Converged);
    EXPECT_NEAR(report.iterations, expected.iterations, 1);
    EXPECT_LE(relativeDifference<double>(copyToHost(context, xOnDevice), x), 1e-6);
  }
};

TEST(CellMultigridTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  CellMultigrid<double, Cuda> inDouble;  // what they keep must fit the next system too
  CellMultigrid<float, Cuda> inSingle;
  // With more cells than a dense matrix takes, a dense one from the second or first level on, cells without an
  // unknown, nothing but surface, no particle.
  for (const Vec<3, int> size :
       {Vec<3, int>{31, 31, 31}, {21, 20, 19}, {9, 9, 9}, {6, 8, 4}, {1, 6, 4}, {0, 1, 1}, {33, 33, 31}}) {
    Twins twins(context, size);
    for (int m : {1, 2, 0})
      for (int n : {1, 4}) {
        twins.check(inDouble, m, n, operatorTolerance);
        twins.check(inSingle, m, n, 10 * singleTolerance);
      }
  }
  EXPECT_GT(inDouble.bytes(), inSingle.bytes());
}

TEST(CellMultigridTwin, SolvesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  for (const Vec<3, int> size : {Vec<3, int>{9, 9, 9}, {31, 31, 31}}) Twins(context, size).checkSolve();
}

}  // namespace
}  // namespace treacle::test
