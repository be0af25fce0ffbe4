#include "support/gpu.hpp"
#include "support/isph_device.hpp"
#include "support/tolerances.hpp"
#include "treacle/precondition/isph_hat_multigrid.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <class T>
constexpr double matrixToleranceOf = std::is_same_v<T, double> ? operatorTolerance : 10 * singleTolerance;

enum class Storage { Plain, Packed };

/// One matrix and its preconditioner on both backends; packed coefficients are those in single precision to its
/// rounding.
template <int D, class T>
struct MatrixTwin {
  IsphScene<D>& s;
  DeviceIsph<D>& d;
  IsphTestSystem<D, T> host;
  DeviceIsphTestSystem<D, T> device;
  std::uint32_t n = s.n();
  std::vector<double> x = randomNumbers(n, 1), r = randomNumbers(n, 2);
  Buffer<double, Cuda> xOnDevice, rOnDevice;
  // Coefficients on the border of two whole units may fall to either; packed ones, which are rounded twice, do
  // more often (measured: 2.5e-4).
  double wholeTolerance;

  template <class HostRow, class DeviceRow>
  MatrixTwin(IsphScene<D>& scene, DeviceIsph<D>& twin, const HostRow& row, const DeviceRow& deviceRow,
             Storage storage)
      : s(scene),
        d(twin),
        host(s, row),
        device(d, deviceRow, storage == Storage::Packed),
        wholeTolerance(storage == Storage::Packed ? 3e-4 : 1e-4) {
    copyToDevice<double>(d.context, x, xOnDevice);
    copyToDevice<double>(d.context, r, rOnDevice);
  }

  void checkParts() {
    EXPECT_LE(differ<double>(d.context, device.diagonal, host.diagonal.span()), matrixToleranceOf<T>);
    EXPECT_LE(differ<T>(d.context, device.inverseNear, host.inverseNear.span()), wholeTolerance);
    const Buffer<IsphMoments<D>> moments = copyToHost(d.context, device.moments);
    std::vector<float> a, b;
    for (std::uint32_t i = 0; i < n; ++i) {
      for (int k = 0; k < D * (D + 1) / 2; ++k) a.push_back(moments[i].m[k]), b.push_back(host.moments[i].m[k]);
      // In other units.
      ASSERT_NEAR(moments[i].own, host.moments[i].own, 1e-5 * (std::abs(host.moments[i].own) + host.diagonal[i]));
    }
    EXPECT_LE(relativeDifference<float>(a, b), 10 * singleTolerance);
  }

  void checkProducts() {
    std::vector<double> y(n);
    Buffer<double, Cuda> found(d.context, n), again(d.context, n);
    multiply<T>(s.context, host.a, x, y);
    multiply<T>(d.context, device.a, xOnDevice, found);
    multiply<T>(d.context, device.a, xOnDevice, again);
    EXPECT_LE(differ<double>(d.context, found, y), matrixToleranceOf<T>) << "product";
    EXPECT_EQ(differ<double>(d.context, again, copyToHost(d.context, found).span()), 0) << "not the same bits";
    std::vector<double> single(n);
    for (std::uint32_t i = 0; i < n; ++i) single[i] = static_cast<float>(x[i]);
    const auto singleOnDevice = copyToDevice<double>(d.context, single);
    multiply<T>(d.context, device.a, singleOnDevice, again);
    multiplySingle<T>(d.context, device.a, singleOnDevice, found);
    EXPECT_EQ(differ<double>(d.context, again, copyToHost(d.context, found).span()), 0)
        << "product of single numbers";
    jacobi<T>(s.context, host.a, r, y);
    jacobi<T>(d.context, device.a, rOnDevice, found);
    EXPECT_LE(differ<double>(d.context, found, y), matrixToleranceOf<T>) << "jacobi";

    std::vector<T> iterate(n), z(n);
    Buffer<T, Cuda> foundZ(d.context, n);
    const double rounded = std::max(matrixToleranceOf<T>, wholeTolerance * (sizeof(T) == 4));
    firstSweep<T>(s.context, host.a, r, z);
    firstSweep<T>(d.context, device.a, rOnDevice, foundZ);
    EXPECT_LE(differ<T>(d.context, foundZ, z), rounded) << "first sweep";
    // An iterate as large as sweeps make it. A much larger one, all of which the last sweep takes away again,
    // would leave nothing but its own rounding.
    for (std::uint32_t i = 0; i < n; ++i) iterate[i] = static_cast<T>(x[i]) * z[i];
    const auto iterateOnDevice = copyToDevice<T>(d.context, iterate);
    nearResidual<T>(s.context, host.a, r, iterate, z);
    nearResidual<T>(d.context, device.a, rOnDevice, iterateOnDevice, foundZ);
    EXPECT_LE(differ<T>(d.context, foundZ, z), rounded) << "near residual";
    lastSweep<T>(s.context, host.a, r, iterate, y);
    lastSweep<T>(d.context, device.a, rOnDevice, iterateOnDevice, found);
    EXPECT_LE(differ<double>(d.context, found, y), rounded) << "last sweep";
  }

  void checkCompressed() {
    BlockCsr<1> expected;
    BlockCsr<1, double, Cuda> found;
    compressed<T>(s.context, host.a, host.a.rows + 3, expected);
    compressed<T>(d.context, device.a, device.a.rows + 3, found);
    EXPECT_LE(valueDifference(onHost(d.context, found), expected), matrixToleranceOf<T>);
  }

  void checkPreconditioner() {
    constexpr std::uint32_t denseUnknowns = 300;  // by default other ones on a device, hence other levels
    IsphHatMultigrid<D, T> k(denseUnknowns);
    IsphHatMultigrid<D, T, Cuda> kOnDevice(denseUnknowns);
    k.setup(s.context, s.pairs, host.a, host.moments, 2);
    kOnDevice.setup(d.context, d.pairs, device.a, device.moments, 2);
    EXPECT_EQ(kOnDevice.gridLevels(), k.gridLevels());
    std::vector<double> z(n);
    Buffer<double, Cuda> found(d.context, n), again(d.context, n);
    k.apply(s.context, r, z);
    kOnDevice.apply(d.context, rOnDevice, found);
    kOnDevice.apply(d.context, rOnDevice, again);
    // Moments are in single precision in any case.
    EXPECT_LE(differ<double>(d.context, found, z), sizeof(T) == 4 ? 3e-4 : 1e-5);
    EXPECT_EQ(differ<double>(d.context, again, copyToHost(d.context, found).span()), 0) << "not the same bits";
  }

  void checkGalerkin() {
    SortedParticles<D> fluid = s.pairs, fluidOnDevice = d.pairs;
    for (SortedParticles<D>* f : {&fluid, &fluidOnDevice}) {
      f->activeCount = f->fluidCount;
      f->cells.wallEnd = f->cells.wallBegin;
    }
    HatNodes<D> nodes;
    HatNodes<D, Cuda> nodesOnDevice;
    findHatNodes(s.context, fluid, HatsOn::Fluid, nodes);
    findHatNodes(d.context, fluidOnDevice, HatsOn::Fluid, nodesOnDevice);
    expectSameBits(d.context, nodes.point, nodesOnDevice.point);
    Buffer<T> parts;
    Buffer<T, Cuda> partsOnDevice;
    BlockCsr<1> expected;
    BlockCsr<1, double, Cuda> found;
    isphGalerkin(s.context, fluid, std::span<const IsphMoments<D>>(host.moments), nodes, parts, expected);
    isphGalerkin(d.context, fluidOnDevice, std::span<const IsphMoments<D>>(device.moments), nodesOnDevice,
                 partsOnDevice, found);
    EXPECT_LE(valueDifference(onHost(d.context, found), expected), 10 * singleTolerance);

    HatTransfer<D, T> transfer;
    HatTransfer<D, T, Cuda> transferOnDevice;
    transfer.prepare(s.context, fluid);
    transferOnDevice.prepare(d.context, fluidOnDevice);
    const std::vector<T> fine(x.begin(), x.end());
    std::vector<T> b(nodes.count()), z = fine;
    Buffer<T, Cuda> bFound(d.context, nodes.count()), zFound = copyToDevice<T>(d.context, fine);
    transfer.restrict(s.context, nodes, fine, std::span<T>(b));
    const auto fineOnDevice = copyToDevice<T>(d.context, fine);
    transferOnDevice.restrict(d.context, nodesOnDevice, fineOnDevice.span(), bFound.span());
    EXPECT_LE(differ<T>(d.context, bFound, b), matrixToleranceOf<T>) << "restriction of particles";
    Buffer<T, Cuda> sums(d.context, HatTransfer<D, T, Cuda>::sumsPerNode * nodes.count());
    transferOnDevice.restrictFluid(d.context, nodesOnDevice, fineOnDevice.span(), sums, bFound.span());
    EXPECT_LE(differ<T>(d.context, bFound, b), matrixToleranceOf<T>) << "restriction";
    transfer.addProlonged(s.context, nodes, std::span<const T>(b), std::span<T>(z));
    transferOnDevice.addProlonged(d.context, nodesOnDevice, copyToDevice<T>(d.context, b).span(), zFound.span());
    EXPECT_LE(differ<T>(d.context, zFound, z), matrixToleranceOf<T>) << "prolongation";
  }

  void checkAll() {
    checkParts();
    checkProducts();
    checkCompressed();
    checkGalerkin();
    checkPreconditioner();
  }
};

template <int D>
void checkScene(IsphScene<D> s) {
  DeviceIsph<D> d(s);
  const PressureRow<D> row{s.surface.data()}, deviceRow{d.surface.data()};
  const ViscousRow<D> viscous;
  SCOPED_TRACE(testing::Message() << D << "D, " << s.n() << " fluid particles");
  MatrixTwin<D, double>(s, d, row, deviceRow, Storage::Plain).checkAll();
  MatrixTwin<D, float>(s, d, row, deviceRow, Storage::Plain).checkAll();
  MatrixTwin<D, float>(s, d, row, deviceRow, Storage::Packed).checkAll();
  MatrixTwin<D, double>(s, d, viscous, viscous, Storage::Plain).checkAll();
  MatrixTwin<D, float>(s, d, viscous, viscous, Storage::Packed).checkAll();
}

template <int D>
void checkScenes() {
  checkScene<D>(makeIsphScene<D>(Walls::Floor));
  checkScene<D>(makeIsphScene<D>(Walls::None));
  checkScene<D>(makeLargeIsphScene<D>());
  // Nothing but surface, or one particle.
  const Case c = waterCase(D, Vec<3>::filled(60));
  for (const int count : {1, 31, 33}) {
    Vec<D, int> size = Vec<D, int>::filled(1);
    size[0] = count;
    checkScene<D>({c, particlesAt<D>(latticeAt<D>(Vec<D>::filled(0.1), size, c.spacing))});
  }
}

/// Wide kernels reach more columns than a block of rows can bring together.
void checkWithoutPlaces() {
  IsphScene<3> large = makeLargeIsphScene<3>();
  large.c.method.isph.smoothingRatio = 2;
  IsphScene<3> s(large.c, std::move(large.particles));
  DeviceIsph<3> d(s);
  MatrixTwin<3, float> twin(s, d, PressureRow<3>{s.surface.data()}, PressureRow<3>{d.surface.data()},
                            Storage::Packed);
  std::size_t without = 0;
  for (const ColumnBlocksView::Size& size : copyToHost(d.context, twin.device.entries.blocks.size))
    without += size.runs == 0;
  EXPECT_GT(without, 0u);
  twin.checkParts();
  twin.checkProducts();
  twin.checkCompressed();
}

TEST(IsphMatrixTwin, ProductsWithoutPlacesEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkWithoutPlaces();
}

TEST(IsphMatrixTwin, MatrixAndPreconditionerEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkScenes<2>();
  checkScenes<3>();
}

}  // namespace
}  // namespace treacle::test
