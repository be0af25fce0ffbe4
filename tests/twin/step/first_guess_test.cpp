#include "treacle/step/method/first_guess.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"
#include "support/tolerances.hpp"

namespace treacle::test {
namespace {

template <int D>
struct Pair {
  Context<Cuda> context;
  RandomParticles<D> host;
  Particles<D, Cuda> device;
  Buffer<Vec<D>> after, guess;
  Buffer<Vec<D>, Cuda> deviceAfter, deviceGuess;

  explicit Pair(std::uint32_t fluid) : host(fluid, 100, fluid + 5), after(fluid), guess(fluid) {
    Particles<D>& p = host.particles;
    for (std::uint32_t i = 0; i < fluid; ++i) {
      after[i] = p.position[i];
      if (i % 3 == 0) p.acceleration[i] = {};  // not known
    }
    device = onDevice(context, p);
    deviceAfter = copyToDevice(context, std::span<const Vec<D>>(after));
    deviceGuess.resize(context, fluid);
  }
};

/// What the device fuses rounds once less.
template <int D>
void expectClose(const Context<Cuda>& context, const Buffer<Vec<D>>& host, const Buffer<Vec<D>, Cuda>& device) {
  const Buffer<Vec<D>> found = copyToHost(context, device);
  ASSERT_EQ(found.size(), host.size());
  double scale = 0, difference = 0;
  for (std::size_t i = 0; i < host.size(); ++i) {
    scale = std::max(scale, norm(host[i]));
    difference = std::max(difference, norm(found[i] - host[i]));
  }
  EXPECT_LE(difference, kernelTolerance * scale);
}

template <class P>
auto memoryOf(P& p) {
  return FlowMemory<decltype(p.position.span())::element_type::dimensions>{p.acceleration.span(), p.jerk.span()};
}

template <int D>
void checkFirstGuessSizes() {
  for (const std::uint32_t fluid : {0u, 1u, 31u, 33u, 20011u}) {
    SCOPED_TRACE(testing::Message() << D << "D, " << fluid << " fluid particles");
    Pair<D> pair(fluid);
    Particles<D>& p = pair.host.particles;
    const std::span<const Vec<D>> u = p.velocity.span().first(fluid), v = pair.device.velocity.span().first(fluid);
    updateFlowMemory<D>(pair.host.context, 0.1, 0.07, u, pair.after, memoryOf(p));
    updateFlowMemory<D>(pair.context, 0.1, 0.07, v, pair.deviceAfter, memoryOf(pair.device));
    expectClose<D>(pair.context, p.acceleration, pair.device.acceleration);
    expectClose<D>(pair.context, p.jerk, pair.device.jerk);
    for (const FirstGuess order : {FirstGuess::Last, FirstGuess::Linear, FirstGuess::Quadratic}) {
      const auto next = Extrapolation<D>::make(order, 0.13, 0.1);
      extrapolate<D>(pair.host.context, next, u, memoryOf(p), pair.guess);
      extrapolate<D>(pair.context, next, v, memoryOf(pair.device), pair.deviceGuess);
      expectClose<D>(pair.context, pair.guess, pair.deviceGuess);
    }
  }
}

TEST(FirstGuessTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkFirstGuessSizes<2>();
  checkFirstGuessSizes<3>();
}

}  // namespace
}  // namespace treacle::test
