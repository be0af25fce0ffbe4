#include "support/gpu.hpp"
#include "support/isph_device.hpp"
#include "support/tolerances.hpp"
#include "support/wall_motions.hpp"
#include "treacle/isph/closed_regions.hpp"
#include "treacle/isph/isph_particles.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// The sums of a step on both backends.
template <int D>
struct SumsTwin {
  IsphScene<D> s;
  DeviceIsph<D> d{s};
  std::uint32_t n = s.n(), active = s.pairs.activeCount;
  std::vector<Vec<D>> v = randomVelocities<D>(active, 1);
  std::vector<WallMotion<D>> motion = randomMotions<D>(s.c.domain, 2);
  std::vector<double> p = randomNumbers(n, 2);
  Buffer<Vec<D>, Cuda> vOnDevice;
  Buffer<WallMotion<D>, Cuda> motionOnDevice;
  Buffer<double, Cuda> pOnDevice;
  std::vector<SmoothFlow<D>> flow = std::vector<SmoothFlow<D>>(n);
  Buffer<SmoothFlow<D>, Cuda> foundFlow{d.context, n};

  explicit SumsTwin(IsphScene<D> scene) : s(std::move(scene)) {
    copyToDevice<Vec<D>>(d.context, v, vOnDevice);
    copyToDevice<WallMotion<D>>(d.context, motion, motionOnDevice);
    copyToDevice<double>(d.context, p, pOnDevice);
    s.pairs.wallMotion = motion.data();
    d.pairs.wallMotion = motionOnDevice.data();
  }

  template <class V>
  void expectClose(const Buffer<V, Cuda>& found, const std::vector<V>& expected, const char* what) {
    EXPECT_LE(differ<V>(d.context, found, expected), 2 * kernelTolerance) << what;
  }

  void findAcrossWalls() {
    if (!d.pairs.wallSurface) return;
    sumBesideWalls(d.context, d.pairs, AcrossWallsTerm<D>{});
    const Buffer<SymmetricBlock<D, float>> found = copyToHost(d.context, d.acrossWalls);
    for (std::uint32_t i = 0; i < n; ++i)
      for (int k = 0; k < SymmetricBlock<D>::size; ++k) ASSERT_NEAR(found[i].a[k], s.acrossWalls[i].a[k], 1e-5);
  }

  void checkDensity() {
    Buffer<double, Cuda> density(d.context, n);
    Buffer<Vec<D>, Cuda> deficit(d.context, n);
    Buffer<std::uint8_t, Cuda> surface(d.context, n);
    sumOnFluid(d.context, d.pairs, DensityTerm<D>{density.data(), deficit.data(), surface.data()});
    findAcrossWalls();
    EXPECT_LE(differ<double>(d.context, density, s.density.span()), 2 * kernelTolerance);
    // Of a full lattice the sum is zero but for rounding.
    double apart = 0;
    const Buffer<Vec<D>> lack = copyToHost(d.context, deficit);
    for (std::uint32_t i = 0; i < n; ++i) apart = std::max(apart, norm(lack[i] - s.deficit[i]) * s.c.spacing);
    EXPECT_LE(apart, 1e-13);
    expectSameBits(d.context, s.surface, surface);
  }

  void checkPredictor(const SmoothFlow<D>* hostFlow = nullptr, const SmoothFlow<D>* deviceFlow = nullptr) {
    for (const bool viscous : {true, false}) {
      std::vector<Vec<D>> expected(n);
      Buffer<Vec<D>, Cuda> found(d.context, n);
      sumOnFluid(s.context, s.pairs, PredictorTerm<D>{v.data(), expected.data(), viscous, hostFlow});
      sumOnFluid(d.context, d.pairs, PredictorTerm<D>{vOnDevice.data(), found.data(), viscous, deviceFlow});
      expectClose(found, expected, "predictor");
    }
    ViscousSourceTerm<D> host{v.data(), {}, hostFlow}, device{vOnDevice.data(), {}, deviceFlow};
    std::vector<double> expected[D];
    Buffer<double, Cuda> found[D];
    for (int k = 0; k < D; ++k) {
      expected[k].resize(n);
      found[k].resize(d.context, n);
      host.source[k] = expected[k].data(), device.source[k] = found[k].data();
    }
    sumOnFluid(s.context, s.pairs, host);
    sumOnFluid(d.context, d.pairs, device);
    for (int k = 0; k < D; ++k) expectClose(found[k], expected[k], "viscous source");
  }

  void checkPressure() {
    std::vector<double> expected(n);
    Buffer<double, Cuda> found(d.context, n);
    sumOnFluid(s.context, s.pairs,
               PressureSourceTerm<D>{v.data(), s.density.data(), s.surface.data(), expected.data()});
    sumOnFluid(d.context, d.pairs,
               PressureSourceTerm<D>{vOnDevice.data(), d.density.data(), d.surface.data(), found.data()});
    expectClose(found, expected, "pressure source");

    std::vector<double> density(n);
    Buffer<double, Cuda> foundDensity(d.context, n);
    sumOnFluid(
        s.context, s.pairs,
        PressureSourceTerm<D>{v.data(), s.density.data(), s.surface.data(), expected.data(), density.data()});
    sumOnFluid(d.context, d.pairs,
               PressureSourceTerm<D>{vOnDevice.data(), d.density.data(), d.surface.data(), found.data(),
                                     foundDensity.data()});
    expectClose(found, expected, "source of the flow");
    expectClose(foundDensity, density, "source of the density");

    std::vector<Vec<D>> corrected(n), transport(n);
    Buffer<Vec<D>, Cuda> foundVelocity(d.context, n), foundTransport(d.context, n);
    std::vector<double> share(n), moving = randomNumbers(n, 7);
    Buffer<double, Cuda> foundShare(d.context, n), movingThere = copyToDevice<double>(d.context, moving);
    std::vector<Vec<D>> stopped(n);
    Buffer<Vec<D>, Cuda> foundStopped(d.context, n);
    const CorrectorTerm<D> term{p.data(),     p.data(),       v.data(),      corrected.data(),
                                share.data(), stopped.data(), moving.data(), transport.data()};
    sumOnFluid(s.context, s.pairs, term);
    const CorrectorTerm<D> there{pOnDevice.data(),     pOnDevice.data(),     vOnDevice.data(),
                                 foundVelocity.data(), foundShare.data(),    foundStopped.data(),
                                 movingThere.data(),   foundTransport.data()};
    sumOnFluid(d.context, d.pairs, there);
    expectClose(foundVelocity, corrected, "corrector");
    checkOutside(term, there);
    expectClose(foundTransport, transport, "corrector, velocity that moves particles");
    expectClose(foundShare, share, "share of walls");
    expectClose(foundStopped, stopped, "stopped at walls");

    std::vector<double> walls(active);
    Buffer<double, Cuda> foundWalls = copyToDevice<double>(d.context, walls);
    sumOnWalls(s.context, s.pairs, WallPressureTerm<D>{p.data(), walls.data()});
    sumOnWalls(d.context, d.pairs, WallPressureTerm<D>{pOnDevice.data(), foundWalls.data()});
    expectClose(foundWalls, walls, "wall pressure");

    const std::uint32_t first = s.pairs.fluidOfWalls.first;
    std::vector<Vec<D>> force(s.pairs.fluidOfWalls.count);
    std::vector<Vec<3>> couple(force.size());
    Buffer<Vec<D>, Cuda> foundForce(d.context, force.size());
    Buffer<Vec<3>, Cuda> foundCouple(d.context, force.size());
    for (const bool isExplicit : {true, false}) {
      sumOnWalls(s.context, s.pairs,
                 WallForceTerm<D>{p.data(), v.data(), stopped.data(), true, first, force.data(), couple.data(),
                                  isExplicit ? flow.data() : nullptr});
      sumOnWalls(d.context, d.pairs,
                 WallForceTerm<D>{pOnDevice.data(), vOnDevice.data(), foundStopped.data(), true, first,
                                  foundForce.data(), foundCouple.data(), isExplicit ? foundFlow.data() : nullptr});
      expectClose(foundForce, force, "force on walls");
      expectClose(foundCouple, couple, "couple on walls");
    }
  }

  /// Gas around the free surface, in the corrector of checkPressure(), too, whose results change.
  void checkOutside(const CorrectorTerm<D>& term, const CorrectorTerm<D>& there) {
    const std::vector<double> gas = randomNumbers(n, 9);
    const Buffer<double, Cuda> gasThere = copyToDevice<double>(d.context, gas);
    std::vector<double> source(n);
    Buffer<double, Cuda> foundSource = copyToDevice<double>(d.context, source);
    s.pairs.outside = gas.data(), d.pairs.outside = gasThere.data();
    sumOnFluid(s.context, s.pairs, OutsideTerm<D>{s.surface.data(), source.data()});
    sumOnFluid(d.context, d.pairs, OutsideTerm<D>{d.surface.data(), foundSource.data()});
    expectClose(foundSource, source, "gas in the pressure equation");
    std::vector<Vec<D>> corrected(n);
    Buffer<Vec<D>, Cuda> found(d.context, n);
    CorrectorTerm<D> host = term, device = there;
    host.velocity = corrected.data(), device.velocity = found.data();
    sumOnFluid(s.context, s.pairs, host);
    sumOnFluid(d.context, d.pairs, device);
    expectClose(found, corrected, "corrector with gas");
    s.pairs.outside = nullptr, d.pairs.outside = nullptr;
  }

  /// The flow, and the predictors that damp its hourglass modes.
  void checkHourglass() {
    Buffer<double, Cuda> density(d.context, n);
    Buffer<Vec<D>, Cuda> deficit(d.context, n);
    Buffer<std::uint8_t, Cuda> surface(d.context, n);
    const BothTerms<DensityTerm<D>, SmoothFlowTerm<D>> both{{s.density.data(), s.deficit.data(), s.surface.data()},
                                                            {v.data(), p.data(), flow.data()}};
    sumOnFluid(s.context, s.pairs, both);
    s.findAcrossWalls();
    const BothTerms<DensityTerm<D>, SmoothFlowTerm<D>> device{
        {density.data(), deficit.data(), surface.data()}, {vOnDevice.data(), pOnDevice.data(), foundFlow.data()}};
    sumOnFluid(d.context, d.pairs, device);
    findAcrossWalls();
    EXPECT_LE(differ<double>(d.context, density, s.density.span()), 2 * kernelTolerance);
    const Buffer<SmoothFlow<D>> there = copyToHost(d.context, foundFlow);
    float largest = 0;
    for (const SmoothFlow<D>& f : flow)
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) largest = std::max(largest, std::abs(f.gradient(r, c)));
    for (std::uint32_t i = 0; i < n; ++i) {
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) ASSERT_NEAR(there[i].gradient(r, c), flow[i].gradient(r, c), 1e-6 * largest);
      ASSERT_NEAR(there[i].speed, flow[i].speed, 1e-6 * flow[i].speed);
    }
    copyToDevice<SmoothFlow<D>>(d.context, flow, foundFlow);
    checkPredictor(flow.data(), foundFlow.data());
  }

  /// The viscosities of the turbulence model by the flow of checkHourglass(), and the predictor by them.
  void checkEddies() {
    s.pairs.mixingLength = d.pairs.mixingLength = 0.2 * s.c.spacing;
    s.pairs.mostEddyViscosity = d.pairs.mostEddyViscosity = 5;
    std::vector<float> eddies(n), walls(n);
    Buffer<float, Cuda> foundEddies(d.context, n), foundWalls(d.context, n);
    sumOnFluid(s.context, s.pairs, EddyTerm<D>{v.data(), flow.data(), eddies.data(), walls.data()});
    sumOnFluid(d.context, d.pairs,
               EddyTerm<D>{vOnDevice.data(), foundFlow.data(), foundEddies.data(), foundWalls.data()});
    const Buffer<float> eddiesThere = copyToHost(d.context, foundEddies),
                        wallsThere = copyToHost(d.context, foundWalls);
    for (std::uint32_t i = 0; i < n; ++i) {
      ASSERT_NEAR(eddiesThere[i], eddies[i], 1e-6 * eddies[i]);
      ASSERT_NEAR(wallsThere[i], walls[i], 1e-6 * walls[i]);
    }
    // They are rounded to single precision, so that both must go on with the same ones.
    copyToDevice<float>(d.context, eddies, foundEddies);
    copyToDevice<float>(d.context, walls, foundWalls);
    s.pairs.eddyViscosity = eddies.data(), s.pairs.wallViscosity = walls.data();
    d.pairs.eddyViscosity = foundEddies.data(), d.pairs.wallViscosity = foundWalls.data();
    checkPredictor();
  }

  void checkAll() {
    checkDensity();
    checkPredictor();
    checkHourglass();
    checkPressure();
    checkEddies();
  }
};

template <int D>
void checkScenes() {
  for (const Walls walls : {Walls::Floor, Walls::None})
    for (const KernelKind kernel : {KernelKind::CubicSpline, KernelKind::WendlandC2}) {
      IsphScene<D> s = makeIsphScene<D>(walls);
      s.c.method.isph.kernel = kernel;
      if (kernel == KernelKind::CubicSpline) giveSurfaces(s.c, s.particles);
      SumsTwin<D>(IsphScene<D>(s.c, std::move(s.particles))).checkAll();
    }
  SumsTwin<D>(makeLargeIsphScene<D>()).checkAll();
  // Sizes at the edges of blocks and warps, without interior and without walls.
  const Case c = waterCase(D, Vec<3>::filled(60));
  for (const int count : {0, 1, 31, 33})
    SumsTwin<D>(IsphScene<D>(c, particlesAt<D>(latticeAt<D>(
                                    Vec<D>::filled(0.1),
                                    [&] {
                                      Vec<D, int> size = Vec<D, int>::filled(1);
                                      size[0] = count;
                                      return size;
                                    }(),
                                    c.spacing))))
        .checkAll();
}

TEST(IsphSumsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkScenes<2>();
  checkScenes<3>();
}

template <int D>
void checkParticles() {
  Context<Cpu> host;
  Context<Cuda> context;
  for (const std::size_t n : {0, 1, 31, 33, 20011}) {
    std::vector<double> p = randomNumbers(n, 1);
    std::vector<std::uint8_t> surface(n);
    for (std::size_t i = 0; i < n; ++i) surface[i] = i % 3 == 0;
    const auto surfaceOnDevice = copyToDevice<std::uint8_t>(context, surface);
    for (const bool cut : {false, true}) {
      std::vector<double> expected = p;
      auto found = copyToDevice<double>(context, p);
      settlePressure(host, surface, nullptr, cut, expected);
      settlePressure(context, surfaceOnDevice, nullptr, cut, found);
      EXPECT_EQ(differ<double>(context, found, expected), 0);
    }
    const auto deficit = randomVelocities<D>(n, 2), v = randomVelocities<D>(n, 3);
    const auto vOnDevice = copyToDevice<Vec<D>>(context, v);
    std::vector<Vec<D>> expected(n);
    Buffer<Vec<D>, Cuda> found(context, n);
    const Shifting shifting{0.3, 0.5, 1e-2};
    shiftedVelocity<D>(host, shifting, deficit, surface, v, expected);
    shiftedVelocity<D>(context, shifting, copyToDevice<Vec<D>>(context, deficit), surfaceOnDevice, vOnDevice,
                       found);
    EXPECT_LE(differ<Vec<D>>(context, found, expected), kernelTolerance);
    limitTransport<D>(host, 0.01, 1e-2, v, expected);
    limitTransport<D>(context, 0.01, 1e-2, vOnDevice, found);
    EXPECT_LE(differ<Vec<D>>(context, found, expected), kernelTolerance);
    for (int k = 0; k < D; ++k) {
      std::vector<double> x(n);
      Buffer<double, Cuda> xOnDevice(context, n);
      takeComponent<D>(host, v, k, x);
      takeComponent<D>(context, vOnDevice, k, xOnDevice);
      EXPECT_EQ(differ<double>(context, xOnDevice, x), 0);
      putComponent<D>(host, x, k, expected);
      putComponent<D>(context, xOnDevice, k, found);
    }
    EXPECT_EQ(differ<Vec<D>>(context, found, expected), 0);
  }
}

template <int D>
void checkRegions() {
  IsphScene<D> s = makeRegions<D>(1);
  const DeviceIsph<D> d(s);
  Context<Cuda> context;
  ClosedRegions<Cpu> expected;
  ClosedRegions<Cuda> found;
  findClosedRegions(s.context, s.pairs, s.surface.span(), expected);
  findClosedRegions(context, d.pairs, d.surface.span(), found);
  EXPECT_EQ(found.labels, expected.labels);
  EXPECT_GE(found.labels.size(), 2u);
  expectSameBits(context, expected.label, found.label);
  for (const Level level : {Level::Mean, Level::Least}) {
    std::vector<double> x = randomNumbers(s.n(), 1);
    auto xOnDevice = copyToDevice<double>(context, x);
    takeLevels(s.context, expected, level, std::span(x));
    takeLevels(context, found, level, xOnDevice.span());
    EXPECT_LE(differ<double>(context, xOnDevice, x), kernelTolerance);
  }
  std::vector<float> missing(s.n(), 1);
  auto missingOnDevice = copyToDevice<float>(context, missing);
  fillRegions(s.context, expected, std::span(missing));
  fillRegions(context, found, missingOnDevice.span());
  EXPECT_EQ(differ<float>(context, missingOnDevice, missing), 0);
}

TEST(ClosedRegionsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkRegions<2>();
  checkRegions<3>();
}

TEST(IsphParticlesTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkParticles<2>();
  checkParticles<3>();
}

}  // namespace
}  // namespace treacle::test
