#include "treacle/search/near_places.hpp"

#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

#include <algorithm>
#include <cstring>

namespace treacle::test {
namespace {

/// Random particles around a rectangle across periodic ends, the same ones in the same order.
template <int D>
void compareNear(std::uint32_t fluid, std::uint32_t wall, double reach) {
  RandomParticles<D> r(fluid, wall, fluid + 5 * wall + 3);
  Vec<3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Vec<D>& x : r.particles.position)
    for (int k = 0; k < D; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  const Vec<3> size = high - low;
  const ProbePlaces places{high, {-0.3 * size[0], 0, 0}, {0, -0.2 * size[1], 0}, 2, 2};
  const auto near = Surroundings<D>::of(places, reach * size[0], {low, high, {true, true, false}});
  Context<Cuda> context;
  const Particles<D, Cuda> device = onDevice(context, r.particles);
  Particles<D> a, b;
  const std::uint32_t walls = wall / 2;
  copyNear<D>(r.context, near, r.particles, walls, a);
  copyNear<D>(context, near, device, walls, b);
  ASSERT_EQ(a.numbers(), b.numbers());
  if (fluid > 1000) {
    EXPECT_GT(a.fluidCount, 0u);
    EXPECT_LT(a.fluidCount, fluid);
  }
  const auto same = [](const auto& x, const auto& y) {
    EXPECT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end(),
                           [](const auto& p, const auto& q) { return std::memcmp(&p, &q, sizeof p) == 0; }));
  };
  forEachSharedFieldOf(same, a, b);
  forEachFluidFieldOf(same, a, b);
}

TEST(NearPlacesTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const std::uint32_t fluid : {1u, 33u, 20011u})
    for (const double reach : {0.0, 0.05, 0.2}) {
      compareNear<2>(fluid, 0, reach > 0 ? reach : 0.01);
      compareNear<2>(fluid, 101, reach > 0 ? reach : 0.01);
      compareNear<3>(fluid, 7001, reach > 0 ? reach : 0.1);
    }
}

}  // namespace
}  // namespace treacle::test
