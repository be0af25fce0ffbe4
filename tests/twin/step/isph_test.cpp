#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/state_of.hpp"
#include "support/tolerances.hpp"
#include "support/wall_motions.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/step/readings/diagnostics.hpp"
#include "treacle/step/walls/wall_motion.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Fails unless device memory holds the same but for rounding.
template <int D>
void expectCloseWalls(const Context<Cuda>& context, const Buffer<Vec<D>>& expected,
                      const Buffer<Vec<D>, Cuda>& device) {
  const Buffer<Vec<D>> found = copyToHost(context, device);
  ASSERT_EQ(found.size(), expected.size());
  double most = 0, apart = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    most = std::max(most, norm(expected[i]));
    apart = std::max(apart, norm(found[i] - expected[i]));
  }
  EXPECT_LE(apart, kernelTolerance * most);
}

template <int D>
void checkWallMotions() {
  Context<Cpu> host;
  Context<Cuda> context;
  Domain domain{{-1, -1, -1}, {1, 1, 1}, {true, false, false}};
  const std::vector<WallMotion<D>> motions = randomMotions<D>(domain, 5);
  for (const std::size_t walls : {0, 1, 31, 33, 20011}) {
    std::vector<std::uint8_t> body;
    for (std::size_t i = 0; i < walls; ++i) body.push_back(static_cast<std::uint8_t>(i * i % 5));
    const std::vector<Vec<D>> position = randomVelocities<D>(walls, 3);
    const auto motionsOnDevice = copyToDevice<WallMotion<D>>(context, motions);
    const auto bodyOnDevice = copyToDevice<std::uint8_t>(context, body);
    const auto positionOnDevice = copyToDevice<Vec<D>>(context, position);
    const MovingWalls<D> onDevice{motionsOnDevice, bodyOnDevice, positionOnDevice};
    Buffer<Vec<D>> expected(walls);
    Buffer<Vec<D>, Cuda> found(context, walls);
    setWallVelocities<D>(host, {motions, body, position}, expected);
    setWallVelocities<D>(context, onDevice, found);
    expectCloseWalls(context, expected, found);
    setWallChords<D>(host, {motions, body, position}, expected);
    setWallChords<D>(context, onDevice, found);
    expectCloseWalls(context, expected, found);
  }
}

TEST(WallMotionTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkWallMotions<2>();
  checkWallMotions<3>();
}

TEST(IsphDiagnosticsTwin, DensitiesEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  for (const std::uint32_t n : {0u, 1u, 31u, 33u, 20011u}) {
    const Particles<2> host = particlesAt<2>(randomVelocities<2>(n, 1));
    const Particles<2, Cuda> device = onDevice(context, host);
    std::vector<double> density = randomNumbers(n, 2);
    for (double& x : density) x = 1 + 0.1 * x;
    std::vector<std::uint8_t> surface(n);
    for (std::uint32_t i = 0; i < n; ++i) surface[i] = i % 3 == 0;
    const auto densityOnDevice = copyToDevice<double>(context, density);
    const auto surfaceOnDevice = copyToDevice<std::uint8_t>(context, surface);
    DiagnosticsInput<2> in{host.position, host.velocity, host.material, {}, {}, 1e-3};
    in.materials.count = 1;
    in.materials.density[0] = 1000;
    DiagnosticsInput<2> inOnDevice = in;
    in.density = density, in.surface = surface;
    in.wallDensity = density, in.neighbourDensity = 1.02;
    inOnDevice.wallDensity = densityOnDevice, inOnDevice.neighbourDensity = 1.02;
    inOnDevice.position = device.position, inOnDevice.velocity = device.velocity;
    inOnDevice.material = device.material;
    inOnDevice.density = densityOnDevice, inOnDevice.surface = surfaceOnDevice;
    Context<Cpu> cpu;
    const Diagnostics expected = computeDiagnostics<2>(cpu, in),
                      found = computeDiagnostics<2>(context, inOnDevice);
    EXPECT_NEAR(found.meanDensityRatio, expected.meanDensityRatio, operatorTolerance);
    EXPECT_NEAR(found.meanDensityError, expected.meanDensityError, operatorTolerance);
    EXPECT_EQ(found.interiorParticles, expected.interiorParticles);
    EXPECT_NEAR(found.excessDensity, expected.excessDensity, operatorTolerance);
    EXPECT_EQ(found.insideWalls, expected.insideWalls);

    // The densities of MPH-I.
    in.materials.bulkModulus[0] = inOnDevice.materials.bulkModulus[0] = 1e6;
    in.density = inOnDevice.density = {};
    in.numberDensity = density, in.restDensity = inOnDevice.restDensity = 1.01;
    inOnDevice.numberDensity = densityOnDevice;
    const Diagnostics e = computeDiagnostics<2>(cpu, in), f = computeDiagnostics<2>(context, inOnDevice);
    EXPECT_NEAR(f.excessDensity, e.excessDensity, operatorTolerance);
    EXPECT_NEAR(f.elasticEnergy, e.elasticEnergy, operatorTolerance * e.elasticEnergy);
  }
}

/// A tank that swings, with jittered water in it.
template <int D>
Case swingingTank(PreconditionerKind preconditioner, Precision precision) {
  Case c = tankCase(D, D == 2 ? 24 : 10, D == 2 ? 20 : 9);
  c.solver.preconditioner = preconditioner;
  c.solver.precision = precision;
  c.solver.tolerance = 1e-24;
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation = {{0.005, 0, 0}, 0.1, 0.3};
  return c;
}
template <int D>
Particles<D> jittered(const Case& c) {
  Particles<D> p = created<D>(c);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    for (int k = 0; k < D; ++k) {
      p.position[i][k] += 0.05 * c.spacing * pseudoRandom(D * i + k);
      p.velocity[i][k] = 0.05 * pseudoRandom(D * i + k + 77777);
    }
  return p;
}

/// Farthest apart of the same particles [m].
template <int D>
double farthest(const Particles<D>& a, const Particles<D>& b) {
  std::vector<Vec<D>> x(a.count);
  for (std::uint32_t i = 0; i < a.count; ++i) x[a.id[i]] = a.position[i];
  double distance = 0;
  for (std::uint32_t i = 0; i < b.count; ++i) distance = std::max(distance, norm(b.position[i] - x[b.id[i]]));
  return distance;
}

template <int D>
void compareSteps(const Case& c, const char* what) {
  SCOPED_TRACE(testing::Message() << D << "D, " << what << ", preconditioner "
                                  << static_cast<int>(c.solver.preconditioner) << ", precision "
                                  << static_cast<int>(c.solver.precision));
  Simulation<D> cpu(c, jittered<D>(c));
  Simulation<D, Cuda> cuda(c, jittered<D>(c));
  const bool mixed = c.solver.precision == Precision::Mixed;
  for (int step = 0; step < 20; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    ASSERT_EQ(b.fallbacks, 0) << b.failures;
    ASSERT_LE(b.residual, c.solver.tolerance);
    EXPECT_NEAR(b.iterations, a.iterations, 1 + 0.05 * a.iterations);
    EXPECT_NEAR(b.diagnostics.meanDensityRatio, a.diagnostics.meanDensityRatio, mixed ? 1e-5 : 1e-9);
    EXPECT_EQ(b.diagnostics.interiorParticles, a.diagnostics.interiorParticles);
  }
  Particles<D> found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(stateOf(cpu), found), (mixed ? 1e-5 : 1e-9) * c.spacing);
  double most = 0, apart = 0;
  std::vector<double> pressure(found.count);
  const Particles<D> onCpu = stateOf(cpu);
  for (std::uint32_t i = 0; i < found.count; ++i) pressure[onCpu.id[i]] = onCpu.pressure[i];
  for (std::uint32_t i = 0; i < found.count; ++i) {
    most = std::max(most, found.pressure[i]);
    apart = std::max(apart, std::abs(found.pressure[i] - pressure[found.id[i]]));
  }
  EXPECT_LE(apart, (mixed ? 1e-3 : 1e-7) * most) << "pressures of fluid and walls";
}

template <int D>
void compareAll() {
  using enum PreconditionerKind;
  for (const PreconditionerKind k : {None, Jacobi, CellMultigrid, HatMultigrid})
    for (const Precision precision : {Precision::Double, Precision::Mixed})
      compareSteps<D>(swingingTank<D>(k, precision), "water");
  Case c = swingingTank<D>(HatMultigrid, Precision::Double);
  c.method.isph.shifting = 0.1;
  c.method.isph.negativePressure = true;
  c.method.isph.walls = WallSlip::FreeSlip;
  c.method.isph.kernel = KernelKind::WendlandC2;
  c.time.courant = 0.05;
  c.time.end = 10;
  compareSteps<D>(c, "other settings");
  c = swingingTank<D>(HatMultigrid, Precision::Double);
  c.materials[0].dynamicViscosity = 100;  // by the implicit step
  compareSteps<D>(c, "honey");
  c = swingingTank<D>(HatMultigrid, Precision::Double);
  c.bodies[1].rotation = Rotation{{0.1, 0.1, 0.1}, {0, 0, 1}, 0.5};
  compareSteps<D>(c, "a floor that turns");
}

TEST(IsphTwin, StepsLikeTheCpuWithEveryPreconditioner) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareAll<2>();
  compareAll<3>();
}

TEST(IsphTwin, RunTwiceGivesTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  const auto after = [](const Case& c) {
    Simulation<3, Cuda> simulation(c, jittered<3>(c));
    for (int k = 0; k < 10; ++k) simulation.advance();
    Particles<3> p;
    simulation.copyParticles(p);
    return p;
  };
  Case c = swingingTank<3>(PreconditionerKind::HatMultigrid, Precision::Mixed);
  c.solver.tolerance = 1e-12;
  EXPECT_TRUE(sameBits(after(c), after(c)));
  c.solver.preconditioner = PreconditionerKind::CellMultigrid;
  EXPECT_TRUE(sameBits(after(c), after(c)));
}

TEST(IsphTwin, AContinuedRunGivesTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = swingingTank<2>(PreconditionerKind::HatMultigrid, Precision::Mixed);
  c.solver.tolerance = 1e-12;
  Simulation<2, Cuda> whole(c, jittered<2>(c)), first(c, jittered<2>(c));
  for (int k = 0; k < 8; ++k) whole.advance();
  for (int k = 0; k < 5; ++k) first.advance();
  Particles<2> state, expected, found;
  first.copyParticles(state);
  Simulation<2, Cuda> second(c, std::move(state), first.step(), first.time());
  for (int k = 0; k < 3; ++k) second.advance();
  whole.copyParticles(expected);
  second.copyParticles(found);
  EXPECT_TRUE(sameBits(expected, found));
}

TEST(IsphTwin, FallbacksAndFailuresAreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = swingingTank<2>(PreconditionerKind::HatMultigrid, Precision::Mixed);
  c.solver.tolerance = 1e-12;
  c.solver.hats.iterationBound = 2;
  Simulation<2, Cuda> fallen(c, jittered<2>(c));
  EXPECT_EQ(fallen.advance().fallbacks, 2);
  c.solver.maxIterations = 1;
  Simulation<2, Cuda> failing(c, jittered<2>(c));
  Particles<2> before, after;
  failing.copyParticles(before);
  const std::string message = [&] {
    try {
      failing.advance();
    } catch (const RunError& error) {
      return std::string(error.what());
    }
    return std::string("no failure");
  }();
  EXPECT_EQ(message.find("pressure: "), 0u) << message;
  failing.copyParticles(after);
  EXPECT_EQ(farthest(before, after), 0);
  EXPECT_EQ(failing.step(), 0);
}

}  // namespace
}  // namespace treacle::test
