#include "treacle/search/near_places.hpp"
#include "treacle/step/readings/probe_sums.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"

namespace treacle::test {
namespace {

constexpr double spacing = 1e-3;

/// A lattice that fills a box of so many spacings, at one velocity.
template <int D>
Particles<D> lattice(const Vec<D, int>& count, const Vec<D>& velocity) {
  std::uint32_t n = 1;
  for (int k = 0; k < D; ++k) n *= static_cast<std::uint32_t>(count[k]);
  Particles<D> p;
  p.resize(n, 0);
  for (std::uint32_t i = 0, rest = 0; i < n; ++i) {
    rest = i;
    for (int k = 0; k < D; ++k) {
      p.position[i][k] = (static_cast<double>(rest % static_cast<std::uint32_t>(count[k])) + 0.5) * spacing;
      rest /= static_cast<std::uint32_t>(count[k]);
    }
    p.velocity[i] = velocity;
    p.pressure[i] = 100 * p.position[i][0];
    p.material[i] = p.position[i][0] > 5 * spacing ? 1 : 0;
    p.id[i] = i;
  }
  return p;
}

template <int D>
PartSums sumsOf(const Particles<D>& p, const Probe& probe, const Domain& domain = {}) {
  Case c;
  c.domain = domain;
  c.dimensions = D;
  c.spacing = spacing;
  c.materials.resize(2);
  c.materials[0].name = "light", c.materials[1].name = "heavy";
  PartTerms<D> terms{};
  terms.weight = PartWeight<D>::of(probe, c);
  terms.density[0] = 1000, terms.density[1] = 3000;
  terms.viscosities.of[0] = Rheology::newtonian(2), terms.viscosities.of[1] = Rheology::newtonian(4);
  terms.volume = std::pow(spacing, D);
  terms.position = p.position.span(), terms.velocity = p.velocity.span();
  terms.pressure = p.pressure.span(), terms.material = p.material.span();
  Context<Cpu> context;
  return sumPart<D>(context, terms);
}

TEST(ProbeSums, OfAllFluid) {
  const Particles<2> p = lattice<2>({10, 8}, {0.5, -1});
  const PartSums s = sumsOf<2>(p, {.kind = ProbeKind::Region});
  EXPECT_NEAR(s.volume, 80e-6, 1e-18);
  EXPECT_NEAR(s.mass, 0.16, 1e-14);
  EXPECT_NEAR(s.moment[0] / s.mass, (0.04 * 2.5 + 0.12 * 7.5) / 0.16 * spacing, 1e-14);
  EXPECT_NEAR(s.flow[0], 40e-6, 1e-17);
  EXPECT_NEAR(s.momentum[1], -0.16, 1e-13);
  EXPECT_NEAR(s.pressure / s.volume, 0.5, 1e-12);
  EXPECT_NEAR(s.viscosity / s.volume, 3, 1e-12);
  EXPECT_NEAR(sumsOf<2>(p, {.kind = ProbeKind::Region, .material = "heavy"}).mass, 0.12, 1e-14);
}

/// Particles count by the part of their cubes that is below: levels between layers are met.
TEST(ProbeSums, OfWhatIsBelowALevel) {
  const Particles<3> p = lattice<3>({6, 9, 5}, {});
  for (const double level : {0.0, 0.3, 2.0, 4.75, 9.0, 20.0}) {
    Probe probe{.kind = ProbeKind::Region, .point = {0, level * spacing, 0}, .normal = {0, 7, 0}};
    EXPECT_NEAR(sumsOf<3>(p, probe).volume, 30e-9 * std::min(level, 9.0), 1e-18) << level;
    probe.box = {{1e-3, 0, 0}, {4.5e-3, 1, 1}};
    EXPECT_NEAR(sumsOf<3>(p, probe).volume, 17.5e-9 * std::min(level, 9.0), 1e-18) << level;
  }
}

/// Of one velocity, through planes anywhere between the ends: exact along the lattice, nearly so across it.
TEST(ProbeSums, OfWhatFlowsThroughAPlane) {
  const Particles<3> p = lattice<3>({20, 6, 5}, {0.1, 0.02, 0});
  for (const double x : {5.0, 5.2, 7.5, 9.9}) {
    const Probe across{.kind = ProbeKind::Flow, .point = {x * spacing, 0, 0}, .normal = {2, 0, 0}};
    EXPECT_NEAR(sumsOf<3>(p, across).flow[0], 0.1 * 30e-6, 1e-15) << x;
    Probe part = across;
    part.box = {{0, 0, 0}, {1, 2e-3, 1}};
    EXPECT_NEAR(sumsOf<3>(p, part).flow[0], 0.1 * 10e-6, 1e-15) << x;
  }
  // The ends of a periodic domain are one plane, and no other one.
  const Domain periodic{{0, -1, -1}, {20 * spacing, 1, 1}, {true, false, false}};
  for (const double x : {0.0, 0.8, 19.0, 20.0}) {
    const Probe end{.kind = ProbeKind::Flow, .point = {x * spacing, 0, 0}, .normal = {1, 0, 0}};
    EXPECT_NEAR(sumsOf<3>(p, end, periodic).flow[0], 0.1 * 30e-6, 1e-15) << x;
  }
  const Particles<2> q = lattice<2>({60, 60}, {0.1, 0.3});
  const Vec<3> normal{0.6, 0.8, 0};
  const Probe oblique{.kind = ProbeKind::Flow, .point = {30.3e-3, 30.1e-3, 0}, .normal = normal};
  // The line cuts the square from (0, y) to (60, y - 45).
  EXPECT_NEAR(dot(sumsOf<2>(q, oblique).flow, normal), 0.3 * 75e-3, 0.005 * 0.3 * 75e-3);
}

TEST(Surroundings, AreThoseOfTheRectangleAndItsImages) {
  const Domain domain{{0, 0, 0}, {10, 10, 10}, {true, false, true}};
  const ProbePlaces places{{9, 2, 3}, {0, 4, 0}, {0, 0, 2}, 3, 3};
  const auto near = Surroundings<3>::of(places, 1.5, domain);
  EXPECT_EQ(near.images, 9);
  for (const auto& [x, expected] : {std::pair{Vec<3>{9, 4, 4}, true},
                                    {{10.4, 4, 4}, true},
                                    {{0.4, 4, 4}, true},
                                    {{0.6, 4, 4}, false},
                                    {{9, 0.6, 4}, true},
                                    {{9, 0.4, 4}, false},
                                    {{9, 7.4, 5}, true},
                                    {{9, 4, 6.6}, false},
                                    {{8, 1, 2}, false},
                                    {{8.2, 1.2, 2.2}, true}})
    EXPECT_EQ(near.holds(x), expected) << x[0] << ' ' << x[1] << ' ' << x[2];
  EXPECT_EQ((Surroundings<2>::of({{1, 1, 0}}, 1, {{0, 0, 0}, {9, 9, 0}, {true, true, false}}).images), 9);
  EXPECT_TRUE((Surroundings<2>::of({{1, 1, 0}}, 1.5, {{0, 0, 0}, {9, 9, 0}, {true, true, false}}).holds({9, 9})));
}

/// The particles that a probe gets are all that are near, walls too, whatever the search has done to their order.
TEST(Measure, CopiesWhatIsNear) {
  Case c = blockCase(2, 1400);
  c.gravity = {0, -10, 0};
  Probe point{.name = "here", .point = {3.2e-3, 0.2e-3, 0}};
  c.probes = {point};
  AnySimulation simulation(c, created<2>(c));
  for (int k = 0; k < 3; ++k) simulation.advance();
  AnyParticles all(2);
  simulation.copyParticles(all);
  const std::vector<ProbeReading> readings = simulation.measure(1);
  ASSERT_EQ(readings.size(), 1u);
  const Particles<2>&some = readings[0].particles.of<2>(), &whole = all.of<2>();
  std::uint32_t fluid = 0, walls = 0;
  for (std::uint32_t i = 0; i < whole.count; ++i)
    if (norm(resized<3>(whole.position[i]) - point.point) <= probeReach * c.spacing)
      ++(i < whole.fluidCount ? fluid : walls);
  EXPECT_GT(fluid, 5u);
  EXPECT_GT(walls, 5u);
  EXPECT_EQ(some.fluidCount, fluid);
  EXPECT_EQ(some.wallCount(), walls);
  for (std::uint32_t i = 0; i < some.fluidCount; ++i)
    for (std::uint32_t j = 0; j < whole.fluidCount; ++j)
      if (some.id[i] == whole.id[j]) {
        EXPECT_EQ(some.position[i], whole.position[j]);
        EXPECT_EQ(some.pressure[i], whole.pressure[j]);
        ++fluid;
      }
  EXPECT_EQ(fluid, 2 * some.fluidCount);
  EXPECT_TRUE(simulation.measure(0).empty());
}

}  // namespace
}  // namespace treacle::test
