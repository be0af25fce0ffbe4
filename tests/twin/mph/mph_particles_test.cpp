#include "treacle/mph/mph_particles.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "support/tolerances.hpp"

namespace treacle::test {
namespace {

/// The same random particles of five materials on both sides.
template <int D>
struct Twins {
  RandomParticles<D> r;
  Context<Cuda> context;
  Particles<D, Cuda> device;
  MphPairs<D> hostPairs, devicePairs;

  Twins(std::uint32_t fluid, std::uint32_t wall) : r(fluid, wall, fluid + 11 * wall) {
    Particles<D>& p = r.particles;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::uint32_t i = 0; i < p.count; ++i) {
      p.material[i] = static_cast<std::uint8_t>(i % 5);
      p.numberDensity[i] = unit(random);
      p.pressure[i] = unit(random) - 0.5;
    }
    device = onDevice(context, p);
    MaterialTable& table = hostPairs.materials;
    table = {};
    table.count = 5;
    for (int m = 0; m < table.count; ++m) {
      table.density[m] = 1000 + m;
      table.inertia[m] = 1e4 / (1 + m);
      table.bulkViscosity[m] = 3 + 2 * m;
      table.bulkModulus[m] = 1e3 * (m + 1);
    }
    hostPairs.fluidCount = p.fluidCount;
    hostPairs.activeCount = p.count;
    hostPairs.grid = r.grid;
    hostPairs.restDensity = 0.4;
    hostPairs.spacing = 1e-3;
    devicePairs = hostPairs;
    hostPairs.position = p.position;
    hostPairs.material = p.material;
    devicePairs.position = device.position;
    devicePairs.material = device.material;
  }

  /// Norm-wise; the device may fuse a product and a sum.
  template <class T>
  void expectEqual(const Buffer<T>& expected, const Buffer<T, Cuda>& found) {
    const Buffer<T> copy = copyToHost(context, found);
    const std::size_t values = expected.size() * sizeof(T) / sizeof(double);
    const std::span a(reinterpret_cast<const double*>(expected.data()), values),
        b(reinterpret_cast<const double*>(copy.data()), values);
    double norm = 0, error = 0;
    for (std::size_t i = 0; i < values; ++i) norm = std::max(norm, std::abs(a[i]));
    for (std::size_t i = 0; i < values; ++i) error = std::max(error, std::abs(a[i] - b[i]));
    EXPECT_LE(error, kernelTolerance * norm);
  }
};

template <int D>
void checkPressures(Twins<D>& t) {
  const Particles<D>& p = t.r.particles;
  Buffer<double> elastic(p.count), pressure(p.count);
  Buffer<double, Cuda> deviceElastic(t.context, p.count), devicePressure(t.context, p.count);
  elasticPressure<D>(t.r.context, t.hostPairs, p.numberDensity, {}, elastic);
  elasticPressure<D>(t.context, t.devicePairs, t.device.numberDensity, {}, deviceElastic);
  t.expectEqual(elastic, deviceElastic);
  std::vector<Adhesion<D>> adhesion(p.count);  // at rest above or below their density; borne in part
  for (std::size_t i = 0; i < p.count; ++i) adhesion[i] = {0.2 + 0.01 * (i % 89), 0.1 * (i % 11), {}};
  const auto deviceAdhesion = copyToDevice<Adhesion<D>>(t.context, adhesion);
  elasticPressure<D>(t.r.context, t.hostPairs, p.numberDensity, adhesion, elastic);
  elasticPressure<D>(t.context, t.devicePairs, t.device.numberDensity, deviceAdhesion, deviceElastic);
  t.expectEqual(elastic, deviceElastic);
  bulkPressure<D>(t.r.context, t.hostPairs, p.pressure, elastic, pressure);
  bulkPressure<D>(t.context, t.devicePairs, t.device.pressure, deviceElastic, devicePressure);
  t.expectEqual(pressure, devicePressure);
  bulkPressure<D>(t.r.context, t.hostPairs, pressure, {}, pressure);
  bulkPressure<D>(t.context, t.devicePairs, devicePressure, {}, devicePressure);
  t.expectEqual(pressure, devicePressure);
}

template <int D>
void checkInertia(Twins<D>& t) {
  const Particles<D>& p = t.r.particles;
  FrameForce<D> frame{.gravity = Vec<D>::filled(0.3), .turns = true, .center = Vec<D>::filled(0.01)};
  frame.gravity[D - 1] = -9.81;
  frame.axis = D == 2 ? Vec<3>{0, 0, 1} : Vec<3>{0.6, 0, 0.8};
  frame.spin = 3 * frame.axis, frame.spinChange = -2 * frame.axis;
  frame.sine = std::sin(0.3), frame.cosine = std::cos(0.3);
  Buffer<Vec<D>> b(p.fluidCount);
  Buffer<Vec<D>, Cuda> deviceB(t.context, p.fluidCount);
  inertiaAndGravity<D>(t.r.context, t.hostPairs, p.velocity, frame, b);
  inertiaAndGravity<D>(t.context, t.devicePairs, t.device.velocity, frame, deviceB);
  t.expectEqual(b, deviceB);
}

template <int D>
void checkSizes() {
  for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u})
    for (std::uint32_t wall : {0u, 7u, 4001u}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid, " << wall << " wall particles");
      Twins<D> t(fluid, wall);
      checkPressures(t);
      checkInertia(t);
    }
}

TEST(MphParticlesTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkSizes<2>();
  checkSizes<3>();
}

}  // namespace
}  // namespace treacle::test
