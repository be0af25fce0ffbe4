#include "treacle/step/readings/diagnostics.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "support/tolerances.hpp"

namespace treacle::test {
namespace {

template <int D, class Backend>
DiagnosticsInput<D> inputOf(const Particles<D, Backend>& p, const Vec<D>& gravity) {
  DiagnosticsInput<D> in{p.position.span().first(p.fluidCount),
                         p.velocity.span().first(p.fluidCount),
                         p.material.span().first(p.fluidCount),
                         {},
                         {.gravity = gravity},
                         1e-3};
  in.materials.count = 3;
  for (int m = 0; m < 3; ++m) in.materials.density[m] = 1000 + 100 * m;
  return in;
}

/// Extremes are the same bits but for what the device fuses; sums differ by their order.
void expectCloseDiagnostics(const Diagnostics& expected, const Diagnostics& found) {
  const auto close = [](double a, double b) {
    return a == b || std::abs(a - b) <= operatorTolerance * std::abs(a);
  };
  EXPECT_PRED2(close, expected.kineticEnergy, found.kineticEnergy);
  EXPECT_PRED2(close, expected.potentialEnergy, found.potentialEnergy);
  EXPECT_EQ(expected.frontX, found.frontX);
  EXPECT_PRED2(close, expected.top, found.top);
  EXPECT_PRED2(close, expected.maxSpeed, found.maxSpeed);
}

template <int D>
void checkDiagnosticsSizes() {
  Context<Cuda> context;
  Vec<D> gravity = Vec<D>::filled(-0.5);
  gravity[D - 1] = -9.81;
  for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u, 700001u}) {
    SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid particles");
    RandomParticles<D> r(fluid, 100, fluid);
    for (std::uint32_t i = 0; i < r.particles.count; ++i) r.particles.material[i] = i % 3;
    const Particles<D, Cuda> device = onDevice(context, r.particles);
    for (const Vec<D>& g : {gravity, Vec<D>{}}) {
      const Diagnostics found = computeDiagnostics(context, inputOf<D>(device, g));
      expectCloseDiagnostics(computeDiagnostics(r.context, inputOf<D>(r.particles, g)), found);
      const Diagnostics again = computeDiagnostics(context, inputOf<D>(device, g));
      EXPECT_EQ(found.kineticEnergy, again.kineticEnergy);
      EXPECT_EQ(found.potentialEnergy, again.potentialEnergy);
    }
  }
}

TEST(DiagnosticsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkDiagnosticsSizes<2>();
  checkDiagnosticsSizes<3>();
}

}  // namespace
}  // namespace treacle::test
