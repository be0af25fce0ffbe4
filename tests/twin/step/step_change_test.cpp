#include "treacle/step/readings/step_change.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "support/tolerances.hpp"

namespace treacle::test {
namespace {

template <int D>
void checkStepChangeSizes() {
  Context<Cuda> context;
  for (const std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u, 700001u}) {
    SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid particles");
    RandomParticles<D> r(fluid, 100, fluid);
    const Particles<D, Cuda> device = onDevice(context, r.particles);
    const auto termsOf = [&](const auto& p) {
      return StepChangeTerms<D>{p.velocity.span().first(fluid), p.position.span().first(fluid)};
    };
    const StepChange expected = stepChange<D>(r.context, termsOf(r.particles)),
                     found = stepChange<D>(context, termsOf(device)),
                     again = stepChange<D>(context, termsOf(device));
    EXPECT_NEAR(found.speed, expected.speed, operatorTolerance * expected.speed);
    EXPECT_NEAR(found.change, expected.change, operatorTolerance * expected.change);
    EXPECT_EQ(found.speed, again.speed);
    EXPECT_EQ(found.change, again.change);
  }
}

TEST(StepChangeTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkStepChangeSizes<2>();
  checkStepChangeSizes<3>();
}

}  // namespace
}  // namespace treacle::test
