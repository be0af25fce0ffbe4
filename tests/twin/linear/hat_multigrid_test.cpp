#include "treacle/linear/hat_multigrid.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/linear/spectral_estimate.hpp"

#include "support/gpu.hpp"
#include "support/hats.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace treacle::test {
namespace {

/// The same problem on both sides.
template <int D, int B = 1>
struct BothHats {
  HatProblem<D, B> host;
  HatNodes<D, Cuda> nodes;
  BlockCsr<B, double, Cuda> a;

  BothHats(Context<Cuda>& context, const HatCase<D>& c) : host(c, 0.1) {
    numberNodes<D>(context, c.lattice, copyToDevice<std::uint8_t>(context, c.active), nodes);
    a = onDevice(context, host.a);
  }
};

/// Largest eigenvalue of D^-1 A as `backend` estimates it.
template <class T, int B, class Backend>
double estimate(Context<Backend>& context, const BlockCsr<B, double, Backend>& a, int steps) {
  Buffer<Block<B, T>, Backend> value;
  Buffer<T, Backend> inverse;
  value.resize(context, a.value.size());
  inverse.resize(context, std::size_t{B} * a.rows());
  hatValues<T, B>(context, a, value, inverse);
  const BlockCsrView<B, T> matrix{a.rows(), a.value.size(), a.rowStart.data(), a.column.data(), value.data()};
  SpectralEstimate<T, Backend> spectrum;
  spectrum.run(
      context, [&](std::span<const T> x, std::span<T> y) { hatMultiply<T>(context, matrix, x, y); }, inverse,
      steps);
  if constexpr (std::is_same_v<Backend, Cpu>)
    return *spectrum.largest();
  else
    return valueOnHost(context, spectrum.largest());
}

template <int D, int B>
void checkEstimates(Context<Cuda>& context, int size) {
  Context<Cpu> host;
  for (const HatCase<D>& c : hatCases<D>(size))
    for (int steps : {1, 10, 20}) {
      SCOPED_TRACE(testing::Message() << D << "-D, " << c.name << ", " << steps << " steps");
      const BothHats<D, B> both(context, c);
      const double expected = estimate<double>(host, both.host.a, steps);
      EXPECT_NEAR(estimate<double>(context, both.a, steps), expected, 1e-9 * expected);
      // Single precision takes fewer steps until only rounding errors are left, and not always as many on both
      // sides; the last ones change little.
      const double inSingle = estimate<float>(host, both.host.a, steps);
      EXPECT_NEAR(estimate<float>(context, both.a, steps), inSingle, 2e-3 * inSingle);
    }
}

TEST(SpectralEstimateTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  checkEstimates<2, 1>(context, 6);
  checkEstimates<2, 1>(context, 110);
  checkEstimates<3, 1>(context, 7);
  checkEstimates<3, 1>(context, 24);
  checkEstimates<2, 2>(context, 40);
  checkEstimates<3, 3>(context, 7);
}

/// Results of the cycle on both sides, the objects being set up anew for each case.
template <int D, class T, int B>
struct Cycles {
  Context<Cpu> host;
  Context<Cuda>& context;
  HatMultigrid<D, T, Cpu, B> onCpu{50 * B};
  HatMultigrid<D, T, Cuda, B> onGpu{50 * B};

  explicit Cycles(Context<Cuda>& c) : context(c) {}

  void check(const HatCase<D>& c, int degree, double tolerance) {
    SCOPED_TRACE(testing::Message() << D << "-D, " << c.name << ", " << c.active.size() << " points, degree "
                                    << degree << ", " << B << " numbers per node"
                                    << (sizeof(T) == 4 ? ", single precision" : ""));
    BothHats<D, B> both(context, c);
    onCpu.setup(host, both.host.nodes, both.host.a, {degree, both.host.reach});
    onGpu.setup(context, both.nodes, both.a, {degree, both.host.reach});
    ASSERT_EQ(onGpu.levelCount(), onCpu.levelCount());
    std::vector<T> b(both.host.unknowns());
    for (std::size_t i = 0; i < b.size(); ++i) onCpu.rhs()[i] = b[i] = pseudoRandom(static_cast<std::uint32_t>(i));
    ASSERT_EQ(onGpu.rhs().size(), b.size());
    const auto setRhs = [&](std::span<T> rhs) {
      copyBytesToDevice(context, b.data(), rhs.data(), b.size() * sizeof(T));
    };
    setRhs(onGpu.rhs());
    onCpu.cycle(host);
    const Buffer<T> x = cycle(onGpu), again = cycle(onGpu);
    EXPECT_LE((relativeDifference<T>(x.span(), onCpu.solution())), tolerance);
    EXPECT_TRUE(std::equal(x.begin(), x.end(), again.begin())) << "not the same bits";
  }

  Buffer<T> cycle(HatMultigrid<D, T, Cuda, B>& multigrid) {
    Buffer<T> x;
    multigrid.cycle(context);
    copyToHost<T>(context, multigrid.solution(), x);
    return x;
  }
};

template <int D, int B>
void checkCycles(Context<Cuda>& context, int size) {
  Cycles<D, double, B> inDouble(context);
  Cycles<D, float, B> inSingle(context);
  for (const HatCase<D>& c : hatCases<D>(size))
    for (int degree : {1, 2, 4}) {
      // The inverse of singular coarse operators is large where interpolation makes nothing of it
      // (regularisation).
      const bool singular = c.name == "ball that nearly touches its image" || c.name == "scattered";
      inDouble.check(c, degree, singular ? 1e-4 : 1e-11);
      inSingle.check(c, degree, singular ? 3e-2 : 1e-4);
    }
}

TEST(HatMultigridTwin, CyclesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  checkCycles<2, 1>(context, 6);
  checkCycles<2, 1>(context, 110);
  checkCycles<3, 1>(context, 7);
  checkCycles<3, 1>(context, 24);
  checkCycles<2, 2>(context, 6);
  checkCycles<2, 2>(context, 110);
  checkCycles<3, 3>(context, 7);
  checkCycles<3, 3>(context, 17);
}

}  // namespace
}  // namespace treacle::test
