#include "treacle/linear/deflation.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace treacle::test {
namespace {

template <class T = double>
std::vector<T> randomValues(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<T> v(n);
  for (T& x : v) x = static_cast<T>(normal(random));
  return v;
}

template <class T>
double distance(const std::vector<T>& a, const Buffer<T>& b) {
  double sum = 0, norm = 1e-300;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += std::pow(double(a[i]) - double(b[i]), 2);
    norm += double(a[i]) * double(a[i]);
  }
  return std::sqrt(sum / norm);
}

/// One vector on both sides.
template <class T = double>
struct BothFields {
  std::vector<T> host;
  Buffer<T, Cuda> device;

  BothFields(const Context<Cuda>& context, std::size_t n, unsigned seed)
      : host(randomValues<T>(n, seed)), device(copyToDevice<T>(context, host)) {}
  double difference(const Context<Cuda>& context) const { return distance(host, copyToHost(context, device)); }
};

/// Scalars on both sides.
template <class S>
struct BothDeflationScalars {
  S host;
  Buffer<S, Cuda> device;

  BothDeflationScalars(const Context<Cuda>& context, const S& start) : host(start), device(context, 1) {
    copyBytesToDevice(context, &start, device.data(), sizeof(start));
  }
  S found(const Context<Cuda>& context) const { return valueOnHost(context, device.data()); }
};

void expectNear(const double* found, const double* expected, int count, double tolerance) {
  for (int j = 0; j < count; ++j) EXPECT_NEAR(found[j], expected[j], tolerance) << j;
}

void compareDeflated(std::size_t n, int modes) {
  SCOPED_TRACE(testing::Message() << n << " unknowns, " << modes << " modes");
  Context<Cpu> cpu;
  Context<Cuda> cuda;
  const double scale = kernelTolerance * (1 + std::sqrt(double(n)));
  BothFields<float> w(cuda, n * modes, 1);
  BothFields aw(cuda, n * modes, 2), r(cuda, n, 3), z(cuda, n, 4), p(cuda, n, 5), x(cuda, n, 6), wide(cuda, n, 7);
  KrylovScalars start;
  start.bb = 3, start.iteration = 1, start.rho = 2;
  BothDeflationScalars<KrylovScalars> k(cuda, start);
  BothDeflationScalars<DeflationScalars> s(cuda, {});
  const Deflated host{w.host, aw.host, modes, &s.host};
  const Deflated device{w.device, aw.device, modes, s.device.data()};

  widen(cpu, std::span<const float>(w.host).first(n), wide.host);
  widen(cuda, std::span<const float>(w.device.span()).first(n), wide.device);
  EXPECT_EQ(wide.difference(cuda), 0);
  for (int j = 0; j < modes; ++j) galerkinRow(cpu, host, j), galerkinRow(cuda, device, j);
  const ModeMatrix galerkin = s.found(cuda).galerkin;
  for (int j = 0; j < modes; ++j) expectNear(&galerkin.value[16 * j], &s.host.galerkin(j, 0), modes, 10 * scale);

  ModeMatrix inverse{};
  for (int i = 0; i < modes; ++i)
    for (int j = 0; j < modes; ++j) inverse(i, j) = (i == j ? 1.0 : 0.01 * (i + j)) / double(n + 1);
  setInverse(cpu, inverse, &s.host);
  setInverse(cuda, inverse, s.device.data());
  deflateGuess(cpu, host, x.host, r.host, &k.host);
  deflateGuess(cuda, device, x.device, r.device, k.device.data());
  expectNear(s.found(cuda).weight, s.host.weight, modes, scale);
  EXPECT_NEAR(k.found(cuda).rr, k.host.rr, 1e-12 * (1 + k.host.rr));
  EXPECT_EQ(k.found(cuda).bb, 3);
  for (int iteration = 0; iteration < 2; ++iteration) {
    deflatedDirection(cpu, host, r.host, z.host, p.host, &k.host);
    deflatedDirection(cuda, device, r.device, z.device, p.device, k.device.data());
    KrylovScalars next = k.found(cuda);
    expectNear(s.found(cuda).weight, s.host.weight, modes, scale);
    EXPECT_NEAR(next.rho, k.host.rho, scale * std::sqrt(1 + double(n)));
    next.iteration = k.host.iteration = 1;
    copyBytesToDevice(cuda, &next, k.device.data(), sizeof(next));
  }
  for (const BothFields<>* v : {&x, &r, &p}) EXPECT_LE(v->difference(cuda), 1e-11);
}

TEST(DeflationTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const int modes : {1, 4, 7, 8, 16})
    for (const std::size_t n : {1u, 31u, 33u, 100003u}) compareDeflated(n, modes);
}

TEST(DeflationTwin, RecordsAndCombinesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cpu> cpu;
  Context<Cuda> cuda;
  constexpr int rows = DeflationScalars::maxBasis;
  for (const std::size_t n : {0u, 1u, 31u, 33u, 10007u}) {
    SCOPED_TRACE(n);
    BothFields r(cuda, n, 1), p(cuda, n, 2);
    BothFields<float> basis(cuda, n * rows, 3), w(cuda, n * 3, 4);
    BothDeflationScalars<KrylovScalars> k(cuda, {});
    BothDeflationScalars<DeflationScalars> s(cuda, {});
    for (const int iteration : {0, 1, 2, rows - 1, rows, rows + 1}) {
      KrylovScalars now = k.host;
      now.iteration = iteration, now.alpha = 1 + iteration;
      k.host = now;
      copyBytesToDevice(cuda, &now, k.device.data(), sizeof(now));
      BothFields z(cuda, n, 10 + iteration);
      for (double& v : z.host) v = std::abs(v);
      copyToDevice<double>(cuda, z.host, z.device);
      recordedDirection(cpu, z.host, z.host, p.host, &k.host, &s.host, basis.host);
      recordedDirection(cuda, z.device, z.device, p.device, k.device.data(), s.device.data(), basis.device);
    }
    recordedDirection(cuda, r.device, r.device, p.device, k.device.data(), s.device.data(), {});
    recordedDirection(cpu, r.host, r.host, p.host, &k.host, &s.host, {});
    const DeflationScalars found = s.found(cuda);
    expectNear(found.alpha, s.host.alpha, rows, 0);
    expectNear(found.rho, s.host.rho, rows, kernelTolerance * (1 + double(n)));
    if (n > 0) expectNear(found.beta, s.host.beta, rows, 1e-11);
    EXPECT_LE(p.difference(cuda), 1e-11);
    EXPECT_LE(basis.difference(cuda), 1e-7);

    RitzVectors ritz{3, rows, {}};
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < rows; ++i) ritz.coefficient[j][i] = std::sin(i + 7 * j);
    std::fill(basis.host.begin(), basis.host.end(), 0.5f);
    copyToDevice<float>(cuda, basis.host, basis.device);
    combine(cpu, basis.host, ritz, w.host);
    combine(cuda, basis.device, ritz, w.device);
    EXPECT_LE(w.difference(cuda), 1e-5);
  }
}

TEST(DeflationTwin, SumsHaveTheSameBitsEachTime) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> cuda;
  constexpr std::size_t n = 300007;
  BothFields<float> w(cuda, n * 8, 1);
  BothFields aw(cuda, n * 8, 2);
  BothDeflationScalars<DeflationScalars> s(cuda, {});
  const Deflated d{w.device, aw.device, 8, s.device.data()};
  galerkinRow(cuda, d, 3);
  const ModeMatrix first = s.found(cuda).galerkin;
  for (int repeat = 0; repeat < 20; ++repeat) {
    galerkinRow(cuda, d, 3);
    for (int j = 0; j < 8; ++j) EXPECT_EQ(s.found(cuda).galerkin(3, j), first(3, j));
  }
}

}  // namespace
}  // namespace treacle::test
