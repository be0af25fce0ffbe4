#include "treacle/search/fluid_change.hpp"

#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

#include <cstring>
#include <vector>

namespace treacle::test {
namespace {

/// A random share of the fluid goes, and particles of another set come.
template <int D>
void compareChange(std::uint32_t fluid, std::uint32_t wall, std::uint32_t come, unsigned leaving) {
  RandomParticles<D> r(fluid, wall, fluid + 3 * wall + 7);
  Particles<D> added;
  ParticleNumbers numbers{come};
  numbers.has = r.particles.has;
  added.resize(numbers);
  const auto number = [](auto& field) {
    for (std::size_t i = 0; i < field.size(); ++i) {
      std::decay_t<decltype(field[0])> value{};
      std::memset(&value, static_cast<int>(i % 23), sizeof value);
      field[i] = value;
    }
  };
  forEachSharedFieldOf(number, added);
  forEachFluidFieldOf(number, added);
  std::vector<std::uint8_t> gone(leaving > 0 ? fluid : 0);
  for (std::uint32_t i = 0; i < gone.size(); ++i) gone[i] = i * 2654435761u % 7 < leaving ? 1 + i % 3 : 0;
  Context<Cuda> context;
  Particles<D, Cuda> device = onDevice(context, r.particles);
  Buffer<std::uint8_t, Cuda> goneThere;
  copyToDevice(context, std::span<const std::uint8_t>(gone), goneThere);
  changeFluid<D>(context, goneThere.span(), added, device);
  changeFluid<D>(r.context, gone, added, r.particles);
  EXPECT_EQ(device.fluidCount, r.particles.fluidCount);
  EXPECT_EQ(device.count, r.particles.count);
  forEachFieldOf([&](const auto& a, const auto& b) { expectSameBits(context, a, b); }, r.particles, device);
}

TEST(FluidChangeTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const std::uint32_t fluid : {1u, 31u, 33u, 20011u})
    for (const std::uint32_t come : {0u, 1u, 100u, 30000u})
      for (const unsigned leaving : {0u, 1u, 6u}) {
        SCOPED_TRACE(testing::Message() << fluid << " particles, " << come << " come, " << leaving << "/7 leave");
        compareChange<2>(fluid, 33, come, leaving);
        compareChange<3>(fluid, 7001, come, leaving);
        compareChange<3>(fluid, 0, come, leaving);
      }
}

}  // namespace
}  // namespace treacle::test
