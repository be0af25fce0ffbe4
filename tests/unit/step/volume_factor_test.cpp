#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

namespace treacle::test {
namespace {

/// A tank with a volume factor of the fluid.
Case tank(const std::string& factor, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"material.oil.volume_factor=" + factor};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return readCase(std::string(TREACLE_CASES) + "/../tests/validation/cases/expanding-tank.toml", overrides);
}

struct Level {
  double rise = 0;     // of the centre of mass, over its height at the start
  double density = 0;  // n / n_0 in the mean
};

/// After steps until the time `end` [s].
Level levelAt(const Case& c, double end) {
  std::vector<std::string> notes;
  Simulation<2> s(c, createParticles<2>(c, notes));
  const auto height = [&] {
    const Particles<2> p = stateOf(s);
    double sum = 0;
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) sum += p.position[i][1];
    return sum / p.fluidCount;
  };
  const double start = height();
  StepReport report;
  while (s.time() < end - 1e-9) report = s.advance();
  return {height() / start - 1, report.diagnostics.meanDensityRatio};
}

TEST(VolumeFactors, RaiseAndLowerTheLevel) {
  for (const double change : {0.06, -0.06}) {
    const Level level = levelAt(tank(std::to_string(change) + "*min(4*t, 1) + 1"), 0.4);
    EXPECT_NEAR(level.rise, change, 0.005) << change;
    EXPECT_NEAR(level.density, 1, 2e-3) << change;
  }
}

TEST(VolumeFactors, OfOneChangeNothing) {
  Case none = tank("1 + 0*t");
  none.materials[0].volumeFactor.clear();
  const Level a = levelAt(tank("1 + 0*t"), 0.02), b = levelAt(none, 0.02);
  EXPECT_NEAR(a.rise, b.rise, 1e-9);
  EXPECT_NEAR(a.density, b.density, 1e-9);
}

/// Neighbours count with their volumes, and walls, which do not grow, as ever.
TEST(VolumeFactors, WeighTheNumberDensity) {
  constexpr double factor = 1.1;
  Scene<3> s = makeScene<3>({.scheme = SchemeKind::Accurate});
  const MphPairs<3> pairs = s.pairs();
  const std::vector<double> one(pairs.fluidCount, 1.0), more(pairs.fluidCount, factor);
  std::vector<double> n(pairs.activeCount), weighted(n), open(n), wide(n), walls(pairs.ownFluid());
  numberDensity<3>(s.context, pairs, n, {open, wide}, one);
  numberDensity<3>(s.context, pairs, weighted, {open, wide}, more);
  wallDensity<3>(s.context, pairs, walls);
  const double self = pairs.terms.density(pairs.terms.densityFactor, ExactDistance(0));
  for (std::uint32_t i = 0; i < pairs.ownFluid(); ++i)
    ASSERT_NEAR(weighted[i], factor * (n[i] - walls[i]) + walls[i] + (factor - 1) * self, 1e-12);
}

TEST(VolumeFactors, AreRefusedBesideWhatContradictsThem) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT([] { tank("1 + t", {"method.scheme=published"}); },
              ThrowsMessage<InputError>(HasSubstr("expected method.scheme = \"accurate\" beside it")));
  const std::vector<std::string> heat{"heat.ambient_temperature=300",       "material.oil.specific_heat=1000",
                                      "material.oil.conductivity=1",        "material.steel.specific_heat=1000",
                                      "material.steel.conductivity=1",      "body.oil.temperature=300",
                                      "material.oil.thermal_expansion=1e-3"};
  EXPECT_THAT([&] { tank("1 + t", heat); },
              ThrowsMessage<InputError>(HasSubstr("expected no thermal_expansion beside it")));
}

TEST(VolumeFactors, OutOfBoundsEndARun) {
  const Case c = tank("1 - min(t, 0.3)");
  std::vector<std::string> notes;
  Simulation<2> s(c, createParticles<2>(c, notes));
  const auto run = [&] {
    for (int k = 0; k < 140; ++k) s.advance();
  };
  EXPECT_THAT(run, testing::ThrowsMessage<RunError>(testing::HasSubstr("volume_factor of")));
}

}  // namespace
}  // namespace treacle::test
