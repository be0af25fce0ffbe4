#include "treacle/linear/vector.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/krylov.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace treacle::test {
namespace {

using Values = std::vector<double>;

Values randomValues(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Values v(n);
  for (double& x : v) x = normal(random);
  return v;
}

double distance(const Values& a, const Buffer<double>& b) {
  double sum = 0, norm = 1e-300;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]), norm += a[i] * a[i];
  return std::sqrt(sum / norm);
}

/// One vector on both sides.
struct Both {
  Values host;
  Buffer<double, Cuda> device;

  Both(const Context<Cuda>& context, std::size_t n, unsigned seed)
      : host(randomValues(n, seed)), device(copyToDevice<double>(context, host)) {}
};

/// Scalars on both sides; compare() brings the device's to the host.
struct BothScalars {
  KrylovScalars host;
  Buffer<KrylovScalars, Cuda> device;

  BothScalars(const Context<Cuda>& context, const KrylovScalars& start) : host(start), device(context, 1) {
    copyBytesToDevice(context, &start, device.data(), sizeof(start));
  }
  void compare(const Context<Cuda>& context, double scale) const {
    const KrylovScalars found = valueOnHost(context, device.data());
    for (auto field : {&KrylovScalars::rr, &KrylovScalars::bb, &KrylovScalars::rho})
      EXPECT_NEAR(found.*field, host.*field, kernelTolerance * scale);
    EXPECT_NEAR(found.alpha, host.alpha, 1e-12 * (1 + std::abs(host.alpha)));
    EXPECT_NEAR(found.beta, host.beta, 1e-12 * (1 + std::abs(host.beta)));
    EXPECT_EQ(found.iteration, host.iteration);
    EXPECT_EQ(found.status, host.status);
  }
};

TEST(VectorTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cpu> cpu;
  Context<Cuda> cuda;
  for (std::size_t n : {0u, 1u, 31u, 33u, 100003u}) {
    SCOPED_TRACE(n);
    Both p(cuda, n, 1), q(cuda, n, 2), u(cuda, n, 3), x(cuda, n, 4), r(cuda, n, 5), s(cuda, n, 6), b(cuda, n, 7);
    KrylovScalars start;
    start.iteration = 1, start.rho = 2, start.alpha = 0.3, start.beta = -0.7;
    BothScalars k(cuda, start);
    const double scale = 1 + static_cast<double>(n);

    updateSolution(cpu, {p.host, q.host, x.host, r.host, u.host, s.host}, &k.host);
    updateSolution(cuda, {p.device, q.device, x.device, r.device, u.device, s.device}, k.device.data());
    updateSolution(cpu, {u.host, p.host, x.host, r.host}, &k.host);
    updateSolution(cuda, {u.device, p.device, x.device, r.device}, k.device.data());
    k.compare(cuda, scale);
    directionsCr(cpu, {s.host, r.host, p.host, q.host}, &k.host);
    directionsCr(cuda, {s.device, r.device, p.device, q.device}, k.device.data());
    direction(cpu, x.host, u.host, &k.host);
    direction(cuda, x.device, u.device, k.device.data());
    Both rounded(cuda, n, 8);
    direction(cpu, x.host, rounded.host, &k.host, true);
    direction(cuda, x.device, rounded.device, k.device.data(), true);
    const Buffer<double> found = copyToHost(cuda, rounded.device);
    for (const double v : found) ASSERT_EQ(v, static_cast<float>(v));
    EXPECT_LE(distance(rounded.host, found), singleTolerance);
    directionDot(cpu, p.host, p.host, &k.host);
    directionDot(cuda, p.device, p.device, k.device.data());
    stepDot(cpu, u.host, u.host, &k.host);
    stepDot(cuda, u.device, u.device, k.device.data());
    k.compare(cuda, 10 * scale);
    residual(cpu, b.host, s.host, &k.host);
    residual(cuda, b.device, s.device, k.device.data());
    k.compare(cuda, 10 * scale);
    for (const Both* v : {&p, &q, &u, &x, &r, &s})
      EXPECT_LE(distance(v->host, copyToHost(cuda, v->device)), kernelTolerance);
  }
}

TEST(VectorTwin, SumsHaveTheSameBitsEachTime) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> cuda;
  Both x(cuda, 1000003, 1), y(cuda, 1000003, 2);
  BothScalars k(cuda, {});
  directionDot(cuda, x.device, y.device, k.device.data());
  const double first = valueOnHost(cuda, k.device.data()).rho;
  for (int repeat = 0; repeat < 20; ++repeat) {
    directionDot(cuda, x.device, y.device, k.device.data());
    EXPECT_EQ(valueOnHost(cuda, k.device.data()).rho, first);
  }
}

/// b = x by the given method, A = K = identity.
template <class Backend>
SolveReport solveIdentity(Context<Backend>& context, std::span<const double> b, std::span<double> x, bool cg,
                          const StoppingRule& rule) {
  KrylovWorkspace<Backend> workspace;
  const auto identity = [&](std::span<const double> in, std::span<double> out) { copy(context, in, out); };
  return cg ? conjugateGradient(context, {identity, identity, b, x}, rule, workspace)
            : conjugateResidual(context, {identity, identity, b, x}, rule, workspace);
}

TEST(KrylovLoopTwin, EndsAsOnTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> cuda;
  for (const bool cg : {true, false}) {
    Both b(cuda, 1000, 1);
    Buffer<double, Cuda> x(cuda, 1000);
    clearBytes(cuda, x.data(), 8000);
    SolveReport report = solveIdentity<Cuda>(cuda, b.device, x, cg, {1e-20, 10});
    EXPECT_EQ(report.status, SolveStatus::Converged);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LE(distance(b.host, copyToHost(cuda, x)), kernelTolerance);
    report = solveIdentity<Cuda>(cuda, b.device, x, cg, {1e-20, 10});
    EXPECT_EQ(report.iterations, 0) << "the solution as first guess";
    Buffer<double, Cuda> history(cuda, 11);
    clearBytes(cuda, x.data(), 8000);
    report = solveIdentity<Cuda>(cuda, b.device, x, cg, {1e-20, 10, 0, history.data()});
    EXPECT_EQ(copyToHost(cuda, history)[0], report.startResidual);
    EXPECT_EQ(copyToHost(cuda, history)[1], report.residual);

    clearBytes(cuda, x.data(), 8000);
    report = solveIdentity<Cuda>(cuda, b.device, x, cg, {0, 0});
    EXPECT_EQ(report.status, SolveStatus::IterationLimit);
    b.host[500] = std::nan("");
    copyToDevice<double>(cuda, b.host, b.device);
    EXPECT_EQ(solveIdentity<Cuda>(cuda, b.device, x, cg, {1e-20, 10}).status, SolveStatus::NotFinite);
  }
}

}  // namespace
}  // namespace treacle::test
