#include "treacle/mph/mph_sums.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/mph/mph_repulsion.hpp"
#include "treacle/mph/renormalisation.hpp"
#include "treacle/mph/surface_tension.hpp"
#include "treacle/mph/tension.hpp"
#include "treacle/mph/viscosity_scale.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <class T>
Vector asVector(std::span<const T> values) {
  const auto* numbers = reinterpret_cast<const double*>(values.data());
  return Vector(std::span(numbers, values.size_bytes() / sizeof(double)));
}

/// The relative difference of two results, norm-wise.
template <class T>
double difference(const Context<Cuda>& context, std::span<const T> expected, const Buffer<T, Cuda>& found) {
  const Buffer<T> onHost = copyToHost(context, found);
  const Vector e = asVector<T>(expected), f = asVector<T>(onHost.span());
  EXPECT_EQ(e.size(), f.size());
  return (e - f).norm() / (1e-300 + e.norm());
}

template <int D>
std::vector<Vec<D>> randomVectors(std::uint32_t n, unsigned seed) {
  return unflat<D>(randomVector(Index{D} * n, seed));
}

/// The sums of a step on the device, with lists or from the cell ranges, against those of the CPU.
template <int D>
struct SumsTwin {
  Scene<D> s;
  DeviceScene<D> d;
  std::uint32_t n, active;

  SumsTwin(Walls walls, bool lists, bool twoMaterials, SchemeKind scheme)
      : s(makeScene<D>({.walls = walls, .seed = 3, .twoMaterials = twoMaterials, .scheme = scheme})),
        d(s),
        n(s.pairs().fluidCount),
        active(s.pairs().activeCount) {
    if (!twoMaterials) {
      d.pairs.materials.count = 1;
      for (auto& m : s.particles.material) m = 0;
      copyToDevice<std::uint8_t>(d.context, s.pairs().material, d.material);
      wallTerms<D>(s.context, s.pairs(), s.terms());
      copyToDevice<Block<D>>(d.context, s.wallBlock, d.wallBlock);
    }
    if (lists) return;
    d.pairs.fluidList.offset = d.pairs.wallList.offset = nullptr;
  }

  void checkRenormalisation() {
    if (s.renormalisation.empty()) return;
    Buffer<SymmetricBlock<D>, Cuda> found(d.context, n);
    renormalisation<D>(d.context, d.pairs, found.span());
    EXPECT_LE(difference<SymmetricBlock<D>>(d.context, s.renormalisation.span(), found), kernelTolerance);
    if (!s.pairs().slips()) return;
    Buffer<SlipSide<D>> sides(n);
    Buffer<SlipSide<D>, Cuda> sidesFound(d.context, n);
    slipSides<D>(s.context, s.pairs(), sides);
    slipSides<D>(d.context, d.pairs, sidesFound);
    EXPECT_LE(difference<SlipSide<D>>(d.context, sides.span(), sidesFound), kernelTolerance);
    MphPairs<D> host = s.pairs(), device = d.pairs;
    host.slipSide = sides.data(), device.slipSide = sidesFound.data();
    Buffer<SymmetricBlock<D>> b(n);
    renormalisation<D>(s.context, host, b);
    renormalisation<D>(d.context, device, found.span());
    EXPECT_LE(difference<SymmetricBlock<D>>(d.context, b.span(), found), kernelTolerance);
  }

  void checkViscosityScale() {
    Buffer<double> expected(n);
    Buffer<double, Cuda> found(d.context, n);
    viscosityScale<D>(s.context, s.pairs(), 0.7, expected.span());
    viscosityScale<D>(d.context, d.pairs, 0.7, found.span());
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);
  }

  void checkShearRate() {
    Buffer<double> share(n), expected(n);
    Buffer<double, Cuda> found(d.context, n);
    viscosityScale<D>(s.context, s.pairs(), 1, share.span());
    const auto u = randomVectors<D>(active, 8);
    shearRate<D>(s.context, s.pairs(), u, share, expected.span());
    shearRate<D>(d.context, d.pairs, copyToDevice<Vec<D>>(d.context, u), copyToDevice<double>(d.context, share),
                 found.span());
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);
  }

  void checkScalars() {
    Buffer<double> expected(active);
    Buffer<double, Cuda> found(d.context, active);
    numberDensity<D>(s.context, s.pairs(), expected);
    numberDensity<D>(d.context, d.pairs, found);
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);

    Buffer<double> open(active), wide(active);
    Buffer<double, Cuda> openFound(d.context, active), wideFound(d.context, active);
    numberDensity<D>(s.context, s.pairs(), expected, {open, wide});
    numberDensity<D>(d.context, d.pairs, found, {openFound, wideFound});
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);
    EXPECT_LE(difference<double>(d.context, open.span(), openFound), operatorTolerance);
    EXPECT_LE(difference<double>(d.context, wide.span(), wideFound), kernelTolerance);

    Buffer<double> wallsExpected(n);
    Buffer<double, Cuda> wallsFound(d.context, n);
    wallDensity<D>(s.context, s.pairs(), wallsExpected);
    wallDensity<D>(d.context, d.pairs, wallsFound);
    EXPECT_LE(difference<double>(d.context, wallsExpected.span(), wallsFound), kernelTolerance);

    const auto u = randomVectors<D>(active, 1);
    divergence<D>(s.context, s.pairs(), u, expected);
    divergence<D>(d.context, d.pairs, copyToDevice<Vec<D>>(d.context, u), found);
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);
  }

  /// Of the accurate scheme, whose weight has a value at no distance.
  void checkVolumes() {
    if (s.renormalisation.empty()) return;
    Buffer<double> volume(s.pairs().fluidCount), expected(active), open(active), wide(active);
    Buffer<double, Cuda> found(d.context, active), openFound(d.context, active), wideFound(d.context, active);
    for (std::size_t i = 0; i < volume.size(); ++i) volume[i] = 1 + 0.2 * std::sin(0.7 * i);
    const auto volumeOnDevice = copyToDevice<double>(d.context, volume);
    numberDensity<D>(s.context, s.pairs(), expected, {open, wide}, volume);
    numberDensity<D>(d.context, d.pairs, found, {openFound, wideFound}, volumeOnDevice);
    EXPECT_LE(difference<double>(d.context, expected.span(), found), kernelTolerance);
    EXPECT_LE(difference<double>(d.context, open.span(), openFound), operatorTolerance);
    EXPECT_LE(difference<double>(d.context, wide.span(), wideFound), kernelTolerance);
  }

  void checkVectors() {
    const Vector q = randomVector(active, 2);
    const std::span<const double> qs(q.data(), active);
    std::vector<Vec<D>> expected = randomVectors<D>(n, 3);
    auto found = copyToDevice<Vec<D>>(d.context, expected);
    addPressureGradient<D>(s.context, s.pairs(), qs, -0.7, expected);
    addPressureGradient<D>(d.context, d.pairs, copyToDevice<double>(d.context, qs), -0.7, found.span());
    EXPECT_LE(difference<Vec<D>>(d.context, expected, found), kernelTolerance);

    const auto u = randomVectors<D>(active, 4);
    addWallDrag<D>(s.context, s.pairs(), u, expected);
    addWallDrag<D>(d.context, d.pairs, copyToDevice<Vec<D>>(d.context, u), found.span());
    EXPECT_LE(difference<Vec<D>>(d.context, expected, found), kernelTolerance);
  }

  void checkWallTerms() {
    Buffer<Block<D>, Cuda> block(d.context, n);
    Buffer<Vec<D>, Cuda> gradient(d.context, n);
    wallTerms<D>(d.context, d.pairs, {block.span(), gradient.span()});
    EXPECT_LE(difference<Block<D>>(d.context, s.wallBlock.span(), block), kernelTolerance);
    EXPECT_LE(difference<Vec<D>>(d.context, s.wallGradient.span(), gradient), kernelTolerance);
  }

  void checkBalance() {
    const auto u = randomVectors<D>(active, 6);
    const Vector q = randomVector(active, 7);
    const std::span<const double> qs(q.data(), active);
    const auto uDevice = copyToDevice<Vec<D>>(d.context, u);
    Buffer<double> shear(n), divergence(active - n), density(active - n);
    Buffer<Vec<D>> force(active - n);
    Buffer<double, Cuda> shearFound(d.context, n), divergenceFound(d.context, active - n),
        densityFound(d.context, active - n);
    Buffer<Vec<D>, Cuda> forceFound(d.context, active - n);

    shearDissipation<D>(s.context, s.pairs(), u, shear);
    shearDissipation<D>(d.context, d.pairs, uDevice, shearFound);
    EXPECT_LE(difference<double>(d.context, shear.span(), shearFound), kernelTolerance);

    ClusterList<> walls;
    buildClusterList<D>(s.context, s.pairs().grid, s.ranges(), s.pairs().position,
                        {n, active, {s.pairs().terms.viscosityRadius, 0}, true}, walls);
    const ClusterList<Cuda> wallsDevice = onDevice(d.context, walls);
    fluidAtWalls<D>(s.context, s.pairs(), walls, u, qs, {force.span(), divergence.span(), density.span()});
    fluidAtWalls<D>(d.context, d.pairs, d.pairs.wallList.offset ? wallsDevice.view() : d.pairs.wallList, uDevice,
                    copyToDevice<double>(d.context, qs),
                    {forceFound.span(), divergenceFound.span(), densityFound.span()});
    EXPECT_LE(difference<Vec<D>>(d.context, force.span(), forceFound), kernelTolerance);
    EXPECT_LE(difference<double>(d.context, divergence.span(), divergenceFound), kernelTolerance);
    EXPECT_LE(difference<double>(d.context, density.span(), densityFound), kernelTolerance);
  }

  void checkOperator() {
    const auto u = randomVectors<D>(n, 5);
    std::vector<Vec<D>> expected(n);
    MphOperator<D> host;
    host.prepare(s.context, s.pairs(), s.terms());
    host.multiply(s.context, u, expected);
    MphOperator<D, Cuda> device;
    device.prepare(d.context, d.pairs, d.terms());
    Buffer<Vec<D>, Cuda> found(d.context, n), again(d.context, n);
    const auto uDevice = copyToDevice<Vec<D>>(d.context, u);
    device.multiply(d.context, uDevice, found);
    EXPECT_LE(difference<Vec<D>>(d.context, expected, found), operatorTolerance);
    device.multiply(d.context, uDevice, again);
    EXPECT_EQ(difference<Vec<D>>(d.context, copyToHost(d.context, found).span(), again), 0) << "not the same bits";
  }
};

template <int D>
void checkAll(bool lists) {
  for (const SchemeKind scheme : bothSchemes)
    for (const Walls walls : {Walls::Floor, Walls::None})
      for (const bool twoMaterials : {true, false}) {
        SCOPED_TRACE(testing::Message()
                     << D << "D, " << nameOf(scheme) << ", " << (walls == Walls::Floor ? "floor" : "no walls")
                     << ", " << (twoMaterials ? 2 : 1) << " materials");
        SumsTwin<D> twin(walls, lists, twoMaterials, scheme);
        twin.checkRenormalisation();
        twin.checkViscosityScale();
        twin.checkShearRate();
        twin.checkScalars();
        twin.checkVolumes();
        twin.checkVectors();
        twin.checkWallTerms();
        twin.checkBalance();
        twin.checkOperator();
      }
}

/// Particles so close that they repel each other and the floor.
template <int D>
void checkRepulsion(bool lists) {
  Scene<D> s = makeScene<D>({.seed = 3, .jitter = 0.49, .scheme = SchemeKind::Accurate});
  DeviceScene<D> d(s);
  if (!lists) d.pairs.fluidList.offset = d.pairs.wallList.offset = nullptr;
  const std::uint32_t n = s.pairs().fluidCount, active = s.pairs().activeCount;
  std::vector<Vec<D>> force(n), onWalls(active - n);
  Buffer<double> power(n);
  auto forceFound = copyToDevice<Vec<D>>(d.context, force), wallsFound = copyToDevice<Vec<D>>(d.context, onWalls);
  Buffer<double, Cuda> powerFound(d.context, n);
  const auto u = randomVectors<D>(active, 8);

  addRepulsion<D>(s.context, s.pairs(), 1e3, force);
  addRepulsion<D>(d.context, d.pairs, 1e3, forceFound.span());
  EXPECT_LE(difference<Vec<D>>(d.context, force, forceFound), operatorTolerance);
  addRepulsionOnWalls<D>(s.context, s.pairs(), 1e3, onWalls);
  addRepulsionOnWalls<D>(d.context, d.pairs, 1e3, wallsFound.span());
  EXPECT_LE(difference<Vec<D>>(d.context, onWalls, wallsFound), operatorTolerance);
  repulsionPower<D>(s.context, s.pairs(), 1e3, u, power);
  repulsionPower<D>(d.context, d.pairs, 1e3, copyToDevice<Vec<D>>(d.context, u), powerFound);
  EXPECT_LE(difference<double>(d.context, power.span(), powerFound), operatorTolerance);
}

/// All of mph/tension.hpp, on places as open as they come.
template <int D>
void checkTension(bool lists) {
  Scene<D> s = makeScene<D>({.seed = 3, .jitter = 0.3, .scheme = SchemeKind::Accurate});
  DeviceScene<D> d(s);
  if (!lists) d.pairs.fluidList.offset = d.pairs.wallList.offset = nullptr;
  MphPairs<D> host = s.pairs();
  host.tensionLimit = d.pairs.tensionLimit = 400;  // some would have less
  const std::uint32_t n = host.fluidCount, active = host.activeCount;
  std::vector<double> density(active), open(active), wide(active), walls(n), tension(active), mean(active);
  for (std::uint32_t i = 0; i < active; ++i) {
    density[i] = (0.8 + 0.003 * (i % 83)) * host.restDensity, open[i] = 0.004 * (i % 101);
    wide[i] = 0.8 + 0.003 * (i % 71);
    tension[i] = -50.0 * (i % 13);
    if (i < n) walls[i] = 0.05 * (i % 7) * host.restDensity;
  }
  std::vector<Covered> covered(n);
  std::vector<Vec<D>> force(active), transport(n);
  const auto u = randomVectors<D>(active, 8);
  const auto densityFound = copyToDevice<double>(d.context, density),
             openFound = copyToDevice<double>(d.context, open), wideFound = copyToDevice<double>(d.context, wide),
             wallsFound = copyToDevice<double>(d.context, walls);
  auto tensionFound = copyToDevice<double>(d.context, tension), meanFound = copyToDevice<double>(d.context, mean);
  auto coveredFound = copyToDevice<Covered>(d.context, covered);
  auto forceFound = copyToDevice<Vec<D>>(d.context, force),
       transportFound = copyToDevice<Vec<D>>(d.context, transport);
  const auto uFound = copyToDevice<Vec<D>>(d.context, u);
  const Places around{density, open, wide, walls}, aroundFound{densityFound, openFound, wideFound, wallsFound};

  for (const bool ofWalls : {false, true}) {
    const ClusterListView& list = ofWalls ? host.wallList : host.fluidList;
    tensionForces<D>(s.context, host, list, tension, force);
    tensionForces<D>(d.context, d.pairs, ofWalls ? d.pairs.wallList : d.pairs.fluidList, tensionFound,
                     forceFound.span());
  }
  EXPECT_LE(difference<Vec<D>>(d.context, force, forceFound), operatorTolerance);
  spreadVelocities<D>(s.context, host, 1e-3, u, tension, transport);
  spreadVelocities<D>(d.context, d.pairs, 1e-3, uFound, tensionFound, transportFound.span());
  EXPECT_LE(difference<Vec<D>>(d.context, transport, transportFound), operatorTolerance);
  lackOfDensity<D>(s.context, host, around, covered);
  lackOfDensity<D>(d.context, d.pairs, aroundFound, coveredFound.span());
  EXPECT_LE(difference<Covered>(d.context, covered, coveredFound), operatorTolerance);
  coveredMeans<D>(s.context, host, host.fluidList, covered, mean);
  coveredMeans<D>(d.context, d.pairs, d.pairs.fluidList, coveredFound, meanFound.span());
  EXPECT_LE(difference<double>(d.context, mean, meanFound), operatorTolerance);
  followDensity<D>(s.context, host, 1e-3, around, std::span(mean).first(n), std::span(tension).first(n));
  followDensity<D>(d.context, d.pairs, 1e-3, aroundFound, meanFound.span().first(n), tensionFound.span().first(n));
  coverTension<D>(s.context, host, around, std::span(tension).first(n), covered);
  coverTension<D>(d.context, d.pairs, aroundFound, tensionFound.span().first(n), coveredFound.span());
  coveredMeans<D>(s.context, host, host.wallList, covered, tension);
  coveredMeans<D>(d.context, d.pairs, d.pairs.wallList, coveredFound, tensionFound.span());
  EXPECT_LE(difference<double>(d.context, tension, tensionFound), operatorTolerance);
  EXPECT_LE(difference<Covered>(d.context, covered, coveredFound), operatorTolerance);
  std::vector<SymmetricBlock<D>> b(s.renormalisation.begin(), s.renormalisation.end());
  auto bFound = copyToDevice<SymmetricBlock<D>>(d.context, b);
  letGapsClose<D>(s.context, host, around, b, covered);
  letGapsClose<D>(d.context, d.pairs, aroundFound, bFound.span(), coveredFound.span());
  EXPECT_LE(difference<SymmetricBlock<D>>(d.context, b, bFound), operatorTolerance);
  EXPECT_LE(difference<Covered>(d.context, covered, coveredFound), operatorTolerance);
  letWallsYield(s.context, mean);
  letWallsYield(d.context, meanFound.span());
  EXPECT_LE(difference<double>(d.context, mean, meanFound), operatorTolerance);
  shareTension(s.context, mean, tension);
  shareTension(d.context, meanFound, tensionFound.span());
  EXPECT_LE(difference<double>(d.context, tension, tensionFound), operatorTolerance);
  actingPressures<D>(s.context, host, around, density, mean);
  actingPressures<D>(d.context, d.pairs, aroundFound, densityFound, meanFound.span());
  EXPECT_LE(difference<double>(d.context, mean, meanFound), operatorTolerance);
}

TEST(PairSumsTwin, TensionEqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool lists : {true, false}) {
    checkTension<2>(lists);
    checkTension<3>(lists);
  }
}

TEST(PairSumsTwin, RepulsionEqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool lists : {true, false}) {
    checkRepulsion<2>(lists);
    checkRepulsion<3>(lists);
  }
}

template <int D>
void checkSurfaceTension(bool lists) {
  Scene<D> s = makeScene<D>({.seed = 3, .jitter = 0.3, .scheme = SchemeKind::Accurate});
  DeviceScene<D> d(s);
  if (!lists) d.pairs.fluidList.offset = d.pairs.wallList.offset = nullptr;
  const std::uint32_t n = s.pairs().fluidCount, walls = s.pairs().activeCount - n;
  s.c.materials[0].surfaceTension = 0.07;
  for (std::size_t m = 0; m < s.c.materials.size(); ++m) s.c.materials[m].contactAngle = m % 2 == 0 ? 50 : 130;
  const SurfaceTerms<D> terms = SurfaceTerms<D>::make(s.c);
  std::vector<SurfaceSums<D>> sums(n);
  std::vector<SurfaceFit> fit(n), fitted(n);
  std::vector<SurfaceSlope<D>> slope(n);
  std::vector<WallSums<D>> atWalls(walls);
  std::vector<Adhesion<D>> adhesion(n + walls);
  std::vector<Vec<D>> force(n), unshared(n), smoothed(n), normal(n), ofWalls(n), even(n), reaction(walls),
      load(walls, Vec<D>::filled(1));
  Buffer<SurfaceSums<D>, Cuda> sumsFound(d.context, n);
  Buffer<SurfaceFit, Cuda> fitFound(d.context, n), fittedFound(d.context, n);
  Buffer<SurfaceSlope<D>, Cuda> slopeFound(d.context, n);
  Buffer<WallSums<D>, Cuda> atWallsFound(d.context, walls);
  Buffer<Adhesion<D>, Cuda> adhesionFound(d.context, n + walls);
  Buffer<Vec<D>, Cuda> ofWallsFound(d.context, n), reactionFound(d.context, walls), forceFound(d.context, n),
      unsharedFound(d.context, n), evenFound(d.context, n), smoothedFound(d.context, n), normalFound(d.context, n);
  auto loadFound = copyToDevice<Vec<D>>(d.context, load);
  const SurfaceForces<D> forces{force, unshared, smoothed, normal, fit, ofWalls};
  const SurfaceForces<D> forcesFound{forceFound.span(),  unsharedFound.span(), smoothedFound.span(),
                                     normalFound.span(), fitFound.span(),      ofWallsFound.span()};
  const auto expectSame = [&](std::span<const Vec<D>> expected, const Buffer<Vec<D>, Cuda>& found) {
    EXPECT_LE(difference<Vec<D>>(d.context, expected, found), operatorTolerance);
  };

  ClusterList<Cpu> wallList;  // those of a step do not reach as far
  buildClusterList<D>(s.context, s.pairs().grid, s.ranges(), s.pairs().position,
                      {n, n + walls, {s.c.interactionRadius(), 0}, true}, wallList);
  const ClusterList<Cuda> wallsDevice = onDevice(d.context, wallList.view());
  const ClusterListView wallsFound = lists ? wallsDevice.view() : d.pairs.wallList;

  const std::span<Adhesion<D>> adheres = adhesion;
  surfaceSlope<D>(s.context, s.pairs(), terms, sums, slope, adheres.first(n));
  surfaceSlope<D>(d.context, d.pairs, terms, sumsFound.span(), slopeFound.span(), adhesionFound.span().first(n));
  wallAdhesion<D>(s.context, s.pairs(), terms, wallList.view(), atWalls, adheres.subspan(n));
  wallAdhesion<D>(d.context, d.pairs, terms, wallsFound, atWallsFound.span(), adhesionFound.span().subspan(n));
  EXPECT_LE(difference<WallSums<D>>(d.context, atWalls, atWallsFound), operatorTolerance);
  EXPECT_LE(difference<Adhesion<D>>(d.context, adhesion, adhesionFound), operatorTolerance);
  EXPECT_LE(difference<SurfaceSums<D>>(d.context, sums, sumsFound), operatorTolerance);
  EXPECT_LE(difference<SurfaceSlope<D>>(d.context, slope, slopeFound), operatorTolerance);
  surfaceForces<D>(s.context, s.pairs(), terms, sums, slope, adhesion, forces);
  surfaceForces<D>(d.context, d.pairs, terms, sumsFound.span(), slopeFound.span(), adhesionFound.span(),
                   forcesFound);
  expectSame(force, forceFound), expectSame(unshared, unsharedFound), expectSame(smoothed, smoothedFound);
  expectSame(normal, normalFound), expectSame(ofWalls, ofWallsFound);
  EXPECT_LE(difference<SurfaceFit>(d.context, fit, fitFound), operatorTolerance);
  bendSurface<D>(s.context, s.pairs(), terms, forces, fitted);
  bendSurface<D>(d.context, d.pairs, terms, forcesFound, fittedFound.span());
  expectSame(force, forceFound), expectSame(unshared, unsharedFound);
  EXPECT_LE(difference<SurfaceFit>(d.context, fitted, fittedFound), operatorTolerance);
  evenAlongSurface<D>(s.context, s.pairs(), terms, {normal, fit, force, even, unshared});
  evenAlongSurface<D>(
      d.context, d.pairs, terms,
      {normalFound.span(), fitFound.span(), forceFound.span(), evenFound.span(), unsharedFound.span()});
  expectSame(even, evenFound);
  auto addedFound = copyToDevice<Vec<D>>(d.context, force);
  addSurfaceForces<D>(s.context, even, force);
  addSurfaceForces<D>(d.context, evenFound.span(), addedFound.span());
  expectSame(force, addedFound);
  surfaceOnWalls<D>(s.context, s.pairs(), terms, wallList.view(), {ofWalls, adhesion, reaction, load});
  const auto ofWallsOnDevice = copyToDevice<Vec<D>>(d.context, ofWalls);
  surfaceOnWalls<D>(d.context, d.pairs, terms, wallsFound,
                    {ofWallsOnDevice.span(), adhesionFound.span(), reactionFound.span(), loadFound.span()});
  EXPECT_LE(difference<Vec<D>>(d.context, reaction, reactionFound), operatorTolerance);
  EXPECT_LE(difference<Vec<D>>(d.context, load, loadFound), operatorTolerance);
}

TEST(PairSumsTwin, SurfaceTensionEqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool lists : {true, false}) {
    checkSurfaceTension<2>(lists);
    checkSurfaceTension<3>(lists);
  }
}

TEST(PairSumsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkAll<2>(true);
  checkAll<3>(true);
}

TEST(PairSumsTwin, FromCellRangesEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkAll<2>(false);
  checkAll<3>(false);
}

}  // namespace
}  // namespace treacle::test
