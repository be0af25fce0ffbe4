#include "treacle/linear/krylov.hpp"
#include "support/device_faults.hpp"
#include "support/gpu.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/model/case/case.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace treacle::test {
namespace {

constexpr std::size_t particles = 5000;

std::span<const Vec<2>> asVectors(std::span<const double> flat) {
  return {reinterpret_cast<const Vec<2>*>(flat.data()), flat.size() / 2};
}
std::span<Vec<2>> asVectors(std::span<double> flat) {
  return {reinterpret_cast<Vec<2>*>(flat.data()), flat.size() / 2};
}

/// A solve of diag(1 … 1000) x = 1 whose product with the matrix has a NaN after so many of them; negative: never.
struct SpoiltSolve {
  Context<Cuda> context;
  Buffer<Vec<2>, Cuda> diagonal;
  Buffer<double, Cuda> b, x;
  Buffer<int, Cuda> calls;
  KrylovWorkspace<Cuda> workspace;

  SpoiltSolve() {
    std::vector<Vec<2>> values(particles);
    for (std::size_t i = 0; i < particles; ++i) values[i] = {1.0 + double(i % 1000), 1.0 + double(i % 777)};
    copyToDevice<Vec<2>>(context, values, diagonal);
    copyToDevice<double>(context, std::vector<double>(2 * particles, 1.0), b);
    x.resize(context, 2 * particles);
    calls.resize(context, 1);
  }

  SolveReport run(KrylovKind kind, int after) {
    clearBytes(context, x.data(), x.size() * sizeof(double));
    clearBytes(context, calls.data(), sizeof(int));
    const Product a = [&](std::span<const double> from, std::span<double> to) {
      applyDiagonal<2, double>(context, diagonal, asVectors(from), asVectors(to));
      spoil(context, after, calls.data(), to.data() + particles);
    };
    const Product k = [&](std::span<const double> r, std::span<double> z) { copy(context, r, z); };
    const StoppingRule rule{1e-20, 5000, 0, nullptr};
    return kind == KrylovKind::Cg ? conjugateGradient(context, {a, k, b, x}, rule, workspace)
                                  : conjugateResidual(context, {a, k, b, x}, rule, workspace);
  }
};

void checkLoops() {
  SpoiltSolve solve;
  for (const KrylovKind kind : {KrylovKind::Cg, KrylovKind::Cr}) {
    SCOPED_TRACE(kind == KrylovKind::Cg ? "CG" : "CR");
    const SolveReport sound = solve.run(kind, -1);
    EXPECT_EQ(sound.status, SolveStatus::Converged);
    EXPECT_GT(sound.iterations, 20);
    for (const int after : {0, 1, 2, 10}) {
      SCOPED_TRACE(after);
      const SolveReport report = solve.run(kind, after);
      EXPECT_EQ(report.status, SolveStatus::NotFinite);
      EXPECT_LE(report.iterations, after);
    }
    const SolveReport again = solve.run(kind, -1);  // nothing is left of the NaN
    EXPECT_EQ(again.status, SolveStatus::Converged);
    EXPECT_EQ(again.iterations, sound.iterations);
    EXPECT_EQ(again.residual, sound.residual);
  }
}

TEST(KrylovTwin, ANaNInTheMiddleOfAGraphEndsIt) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkLoops();
}

TEST(KrylovTwin, ANaNEndsALoopOfTheHost) {
  TREACLE_SKIP_WITHOUT_GPU();
  const bool wasSet = std::getenv("TREACLE_NO_GRAPHS") != nullptr;
  setenv("TREACLE_NO_GRAPHS", "1", 1);
  checkLoops();
  if (!wasSet) unsetenv("TREACLE_NO_GRAPHS");
}

}  // namespace
}  // namespace treacle::test
