#include "support/device_faults.hpp"
#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace treacle::test {
namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// Fluid on a floor in a domain of so many spacings, three quarters full.
template <int D>
Case layerCase(int size) {
  Case c = sceneCase(D, true, SchemeKind::Accurate);
  c.time.step = 5e-4;
  c.gravity[D - 1] = -10;
  for (int k = 0; k < D; ++k) c.domain.max[k] = size * c.spacing;
  return c;
}
template <int D>
Particles<D> layer(const Case& c) {
  const double floor = 4 * c.spacing, top = 0.75 * c.domain.max[D - 1];
  Particles<D> p = jitteredLattice<D>(
      c, 0.1, 1, [&](const Vec<D>& x) { return x[D - 1] >= floor && x[D - 1] < top; },
      [&](const Vec<D>& x) { return x[D - 1] < floor; });
  for (Vec<D>& u : p.velocity) u = {};
  knowSurface(c, floor, p);
  return p;
}

/// Overwrites values in the memory of a simulation. It has done all that it was asked for.
template <class T>
void poke(const Buffer<T, Cuda>& field, std::size_t first, std::span<const T> values) {
  const Context<Cuda> context;
  copyBytesToDevice(context, values.data(), const_cast<T*>(field.data()) + first, values.size_bytes());
}

template <int D>
std::string messageOfStep(Simulation<D, Cuda>& s) {
  try {
    s.advance();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

/// Of a fluid particle, one coordinate or component of a velocity that is none.
template <int D>
void checkNotFinite(const Case& c, Particles<D> (*make)(const Case&)) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200})
    for (const bool ofVelocity : {true, false}) {
      if (!ofVelocity && !std::isnan(value)) continue;  // of positions infinity means a cell far away
      SCOPED_TRACE(testing::Message() << (c.method.kind == MethodKind::MphI ? "MPH-I in " : "ISPH in ") << D
                                      << "D, " << value << " as " << (ofVelocity ? "velocity" : "position"));
      Simulation<D, Cuda> s(c, make(c));
      for (int k = 0; k < 2; ++k) s.advance();
      const Particles<D> before = stateOf(s);
      const std::uint32_t i = before.fluidCount / 2;
      Vec<D> spoilt = ofVelocity ? before.velocity[i] : before.position[i];
      spoilt[D - 1] = value;
      poke<Vec<D>>(ofVelocity ? s.particles().velocity : s.particles().position, i, {&spoilt, 1});
      const std::string message = messageOfStep(s);
      const auto tells = [&](const char* text) { return message.find(text) != std::string::npos; };
      EXPECT_TRUE(tells("not finite") || (!ofVelocity && tells("left the domain"))) << message;
      EXPECT_EQ(s.step(), 2);
    }
}

TEST(DeviceFailure, AValueThatIsNotFiniteEndsTheStep) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkNotFinite<2>(layerCase<2>(40), layer<2>);
  checkNotFinite<3>(layerCase<3>(20), layer<3>);
  checkNotFinite<2>(tankCase(2, 24, 20), created<2>);
  checkNotFinite<3>(tankCase(3, 10, 9), created<3>);
}

/// What is thrown where device memory does not suffice.
template <class F>
DeviceMemoryNumbers exhausted(F&& f) {
  try {
    f();
  } catch (const DeviceMemoryExhausted& error) {
    return error.numbers();
  }
  ADD_FAILURE() << "device memory was not exhausted";
  return {};
}

TEST(DeviceFailure, OutOfMemoryAtTheStartLeavesTheDeviceUsable) {
  TREACLE_SKIP_WITHOUT_GPU();
  const Case c = layerCase<2>(100);
  const auto stateAfter = [&](int steps) {
    Simulation<2, Cuda> s(c, layer<2>(c));
    for (int k = 0; k < steps; ++k) s.advance();
    return stateOf(s);
  };
  const Particles<2> expected = stateAfter(2);  // its kernels are loaded from now on
  for (const std::size_t left : {std::size_t{0}, 4 * mebibyte}) {
    SCOPED_TRACE(left);
    const MemoryHog hog(left);
    const DeviceMemoryNumbers numbers = exhausted([&] { stateAfter(2); });
    EXPECT_LT(numbers.free, 256 * mebibyte);
    EXPECT_GT(numbers.total, 1024 * mebibyte);
  }
  EXPECT_TRUE(sameBits(expected, stateAfter(2)));
}

/// The fluid pressed into a corner: lists and all that hangs on them need many times the memory.
template <int D>
std::vector<Vec<D>> pressed(const Case& c, const Particles<D>& p, double factor) {
  const double floor = 4 * c.spacing;
  std::vector<Vec<D>> x(p.position.begin(), p.position.begin() + p.fluidCount);
  for (Vec<D>& xi : x) {
    for (int k = 0; k + 1 < D; ++k) xi[k] *= factor;
    xi[D - 1] = floor + factor * (xi[D - 1] - floor);
  }
  return x;
}

TEST(DeviceFailure, OutOfMemoryInTheMiddleKeepsTheState) {
  TREACLE_SKIP_WITHOUT_GPU();
  const Case c = layerCase<3>(48);
  Simulation<3, Cuda> whole(c, layer<3>(c)), s(c, layer<3>(c));
  for (int k = 0; k < 2; ++k) whole.advance(), s.advance();
  Particles<3> good = stateOf(s), spoilt = stateOf(s);
  const std::vector<Vec<3>> x = pressed(c, spoilt, 0.4);
  std::copy(x.begin(), x.end(), spoilt.position.begin());
  poke<Vec<3>>(s.particles().position, 0, x);
  {
    const MemoryHog hog(0);
    const DeviceMemoryNumbers numbers = exhausted([&] { s.advance(); });
    EXPECT_GT(numbers.wanted, 0u);
    EXPECT_GT(numbers.peak, 0u);
    EXPECT_EQ(s.step(), 2);
    // The state can be copied and written while there is no memory.
    const Particles<3> left = stateOf(s);
    EXPECT_TRUE(sameBits(spoilt, left));
    const TemporaryDirectory directory;
    writeCheckpoint<3>(directory / "c.h5", left, s.step(), s.time(), MethodKind::MphI);
    EXPECT_TRUE(sameBits(spoilt, readCheckpoint<3>(directory / "c.h5").particles));
  }
  Simulation<3, Cuda> resumed(c, std::move(good), s.step(), s.time());
  whole.advance(), resumed.advance();
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(resumed)));
}

/// For a process of its own: what is told of a device that is lost between two steps, and that all which holds its
/// memory can be destroyed, made anew in vain, and destroyed again.
[[noreturn]] void loseDeviceBetweenSteps() {
  const Case c = layerCase<2>(40);
  std::string message;
  try {
    Simulation<2, Cuda> s(c, layer<2>(c));
    s.advance();
    const Context<Cuda> context;
    loseDevice(context.stream());
    s.advance();
  } catch (const DeviceFailure& error) {
    message = error.what();
  }
  try {
    Simulation<2, Cuda> s(c, layer<2>(c));
    message += "; a simulation could be made nevertheless";
  } catch (const DeviceFailure&) {
  }
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(message.empty() ? 0 : 3);
}

TEST(DeviceFailureDeathTest, ALostDeviceIsAnErrorLikeOthers) {
  TREACLE_SKIP_WITHOUT_GPU();
  // CUDA cannot be used in a fork of a process that has used it: the test is run anew.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(loseDeviceBetweenSteps(), testing::ExitedWithCode(3),
              "the GPU failed: .* \\(cudaError[A-Za-z]*, noticed at kernels/[a-z_/]*\\.[a-z]*:[0-9]*\\)");
}

}  // namespace
}  // namespace treacle::test
