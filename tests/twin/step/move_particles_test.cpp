#include "treacle/step/method/move_particles.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// A short step that no particle leaves by, then one that many do.
template <int D>
void checkMotion(std::uint32_t fluid, std::uint32_t wall) {
  RandomParticles<D> r(fluid, wall, fluid + 11 * wall);
  Context<Cuda> context;
  Particles<D>& p = r.particles;
  for (Vec<D>& u : p.velocity) u[D - 1] *= 0.5;
  for (Vec<D>& x : p.position) x[D - 1] *= 0.9;
  const Particles<D, Cuda> device = onDevice(context, p);
  Buffer<Vec<D>> moved(p.count);
  Buffer<Vec<D>, Cuda> found(context, p.count);
  for (double dt : {0.1, 1.7}) {
    const std::uint32_t first = moveParticles<D>(r.context, r.grid, dt, p.position, p.velocity, moved);
    if (dt < 1 || p.count > 1000) {
      EXPECT_EQ(first == noParticle, dt < 1);
    }
    EXPECT_EQ(moveParticles<D>(context, r.grid, dt, device.position, device.velocity, found), first);
    const Buffer<Vec<D>> copy = copyToHost(context, found);
    double error = 0, largest = 0;
    for (std::uint32_t i = 0; i < p.count; ++i) {
      error = std::max(error, norm(moved[i] - copy[i]));
      largest = std::max(largest, norm(moved[i]));
    }
    EXPECT_LE(error, kernelTolerance * largest);  // the device may fuse a product and a sum
  }
}

TEST(MoveParticlesTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u})
    for (std::uint32_t wall : {0u, 7u, 4001u}) {
      SCOPED_TRACE(testing::Message() << fluid << " fluid, " << wall << " wall particles");
      checkMotion<2>(fluid, wall);
      checkMotion<3>(fluid, wall);
    }
}

TEST(MoveParticlesTwin, ReportsTheFirstParticleThatIsNotFinite) {
  TREACLE_SKIP_WITHOUT_GPU();
  RandomParticles<3> r(3000, 0, 3000);
  for (std::uint32_t i : {2900u, 1234u, 1235u}) r.particles.velocity[i][1] = NAN;
  Context<Cuda> context;
  const Particles<3, Cuda> device = onDevice(context, r.particles);
  Buffer<Vec<3>, Cuda> moved(context, 3000);
  EXPECT_EQ(moveParticles<3>(context, r.grid, 1e-9, device.position, device.velocity, moved), 1234u);
}

}  // namespace
}  // namespace treacle::test
