#include "treacle/method/explicit_step.hpp"
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
      table.bulkModulus[m] = 1e5 * (m + 1);
    }
    hostPairs.fluidCount = p.fluidCount;
    hostPairs.activeCount = p.count;
    hostPairs.grid = r.grid;
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
  elasticPressure<D>(t.r.context, t.hostPairs, p.numberDensity, 0.4, elastic);
  elasticPressure<D>(t.context, t.devicePairs, t.device.numberDensity, 0.4, deviceElastic);
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
  Vec<D> gravity = Vec<D>::filled(0.3);
  gravity[D - 1] = -9.81;
  Buffer<Vec<D>> b(p.fluidCount);
  Buffer<Vec<D>, Cuda> deviceB(t.context, p.fluidCount);
  inertiaAndGravity<D>(t.r.context, t.hostPairs, p.velocity, gravity, b);
  inertiaAndGravity<D>(t.context, t.devicePairs, t.device.velocity, gravity, deviceB);
  t.expectEqual(b, deviceB);
}

/// A short step that no particle leaves by, then one that many do.
template <int D>
void checkMotion(Twins<D>& t) {
  Particles<D>& p = t.r.particles;
  for (Vec<D>& u : p.velocity) u[D - 1] *= 0.5;
  for (Vec<D>& x : p.position) x[D - 1] *= 0.9;
  copyToDevice(t.context, p, t.device);
  Buffer<Vec<D>> moved(p.count);
  Buffer<Vec<D>, Cuda> deviceMoved(t.context, p.count);
  for (double dt : {0.1, 1.7}) {
    const std::uint32_t first = moveParticles<D>(t.r.context, t.r.grid, dt, p.position, p.velocity, moved);
    if (dt < 1 || p.count > 1000) {
      EXPECT_EQ(first == nobody, dt < 1);
    }
    EXPECT_EQ(moveParticles<D>(t.context, t.r.grid, dt, t.device.position, t.device.velocity, deviceMoved), first);
    t.expectEqual(moved, deviceMoved);
  }
}

template <int D>
void checkSizes() {
  for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u})
    for (std::uint32_t wall : {0u, 7u, 4001u}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid, " << wall << " wall particles");
      Twins<D> t(fluid, wall);
      checkPressures(t);
      checkInertia(t);
      checkMotion(t);
    }
}

TEST(ExplicitStepTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkSizes<2>();
  checkSizes<3>();
}

TEST(ExplicitStepTwin, ReportsTheFirstParticleThatIsNotFinite) {
  TREACLE_SKIP_WITHOUT_GPU();
  Twins<3> t(3000, 0);
  for (std::uint32_t i : {2900u, 1234u, 1235u}) t.r.particles.velocity[i][1] = NAN;
  copyToDevice(t.context, t.r.particles, t.device);
  Buffer<Vec<3>, Cuda> moved(t.context, 3000);
  EXPECT_EQ(moveParticles<3>(t.context, t.r.grid, 1e-9, t.device.position, t.device.velocity, moved), 1234u);
}

}  // namespace
}  // namespace treacle::test
