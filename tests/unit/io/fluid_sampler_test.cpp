#include "compare/fluid_sampler.hpp"

#include "treacle/model/case/probe.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

constexpr double sampledSpacing = 2e-3;

/// A block of particles from the origin on, so many along each axis, with linear fields.
Frame block(int dimensions, int nx, int ny, int nz) {
  Frame frame;
  frame.dimensions = dimensions;
  for (int k = 0; k < (dimensions == 3 ? nz : 1); ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const Vec<3> x = sampledSpacing * Vec<3>{i + 0.5, j + 0.5, dimensions == 3 ? k + 0.5 : 0};
        frame.position.push_back(x);
        frame.velocity.push_back({x[0], -2 * x[1], 3 * x[2]});
        frame.pressure.push_back(7 + 1e3 * x[0] - 500 * x[1]);
      }
  return frame;
}

Domain openDomain() { return {{-1, -1, -1}, {1, 1, 1}, {}}; }

TEST(FluidSampler, MeetsLinearFieldsInsideAndAtTheSurface) {
  for (const int dimensions : {2, 3}) {
    const Frame fluid = block(dimensions, 12, 10, 9);
    Frame none;
    none.dimensions = dimensions;
    const FluidSampler sampler(fluid, none, openDomain(), sampledSpacing);
    const double z = dimensions == 3 ? 4.3 * sampledSpacing : 0;
    for (const Vec<2>& at : {Vec<2>{6, 5}, Vec<2>{6.3, 4.8}, Vec<2>{0, 5.2}, Vec<2>{11.9, 9.9}, Vec<2>{3, 10}}) {
      const Vec<3> x{at[0] * sampledSpacing, at[1] * sampledSpacing, z};
      const FluidSample s = sampler.at(x);
      const bool inside = at[0] > 2.5 && at[0] < 9.5 && at[1] > 2.5 && at[1] < 7.5;
      // At the surface the mean place of the neighbours is a spacing away.
      const double bound = (inside ? 1e-4 : 0.01) * sampledSpacing;
      EXPECT_NEAR(s.velocity[0], x[0], bound);
      EXPECT_NEAR(s.velocity[1], -2 * x[1], 2 * bound);
      EXPECT_NEAR(s.velocity[2], 3 * x[2], 3 * bound);
      EXPECT_NEAR(s.pressure, 7 + 1e3 * x[0] - 500 * x[1], 1200 * bound);
      EXPECT_TRUE(std::isnan(s.temperature));
    }
    for (const Vec<2>& at : {Vec<2>{-1.1, 5}, Vec<2>{6, 11}, Vec<2>{40, 40}})
      EXPECT_TRUE(std::isnan(sampler.at({at[0] * sampledSpacing, at[1] * sampledSpacing, z}).pressure));
  }
}

/// Nothing is known across a film of one layer, or around a single particle.
TEST(FluidSampler, IsConstantAcrossAFilm) {
  const Frame film = block(3, 10, 1, 10), single = block(3, 1, 1, 1), none{};
  const Vec<3> x{5 * sampledSpacing, 0.9 * sampledSpacing, 5 * sampledSpacing};
  const FluidSample s = FluidSampler(film, none, openDomain(), sampledSpacing).at(x);
  EXPECT_NEAR(s.velocity[0], x[0], 1e-9);
  EXPECT_NEAR(s.velocity[1], -sampledSpacing, 1e-9);
  const Vec<3> beside{0.6 * sampledSpacing, 0.7 * sampledSpacing, 0.2 * sampledSpacing};
  EXPECT_NEAR(FluidSampler(single, none, openDomain(), sampledSpacing).at(beside).velocity[0],
              0.5 * sampledSpacing, 1e-12);
  EXPECT_TRUE(std::isnan(FluidSampler(none, none, openDomain(), sampledSpacing).at(beside).velocity[0]));
}

TEST(FluidSampler, SeesPeriodicImages) {
  Domain domain{{0, 0, 0}, {12 * sampledSpacing, 1, 1}, {true, false, false}};
  Frame fluid = block(2, 12, 10, 1);
  for (Vec<3>& u : fluid.velocity) u[0] = 5;
  for (double& p : fluid.pressure) p = 3;
  Frame none;
  none.dimensions = 2;
  const FluidSampler sampler(fluid, none, domain, sampledSpacing);
  for (const double x : {0.0, 0.1, 11.9, 12.0}) {
    EXPECT_NEAR(sampler.fraction({x * sampledSpacing, 5 * sampledSpacing, 0}), 1, 0.02);
    EXPECT_NEAR(sampler.at({x * sampledSpacing, 5 * sampledSpacing, 0}).velocity[0], 5, 1e-12);
    EXPECT_NEAR(sampler.at({x * sampledSpacing, 5 * sampledSpacing, 0}).velocity[1], -10 * sampledSpacing,
                1e-4 * sampledSpacing);
  }
}

/// The level of a block, wherever the line stands, also at a wall; and the other way through it.
TEST(FluidSampler, FindsTheSurface) {
  for (const int dimensions : {2, 3}) {
    const Frame fluid = block(dimensions, 16, 10, 12);
    Frame walls;
    walls.dimensions = dimensions;
    for (int k = 0; k < (dimensions == 3 ? 12 : 1); ++k)
      for (int j = -4; j < 20; ++j)
        for (int i = -4; i < 16; ++i)
          if (i < 0 || j < 0)
            walls.position.push_back(sampledSpacing * Vec<3>{i + 0.5, j + 0.5, dimensions == 3 ? k + 0.5 : 0});
    const FluidSampler sampler(fluid, walls, openDomain(), sampledSpacing);
    const double z = dimensions == 3 ? 6.2 * sampledSpacing : 0;
    for (const double x : {0.5, 1.0, 5.0, 8.0, 8.25, 8.6})
      EXPECT_NEAR(sampler.extent({x * sampledSpacing, 0, z}, {x * sampledSpacing, 25 * sampledSpacing, z}),
                  10 * sampledSpacing, 0.05 * sampledSpacing)
          << x;
    EXPECT_NEAR(
        sampler.extent({5 * sampledSpacing, 5 * sampledSpacing, z}, {30 * sampledSpacing, 5 * sampledSpacing, z}),
        11 * sampledSpacing, 0.05 * sampledSpacing);
    EXPECT_EQ(sampler.extent({40 * sampledSpacing, 0, z}, {40 * sampledSpacing, 25 * sampledSpacing, z}), 0);
    EXPECT_EQ(sampler.extent({8 * sampledSpacing, 0, z}, {8 * sampledSpacing, 6 * sampledSpacing, z}),
              6 * sampledSpacing);
  }
}

TEST(ProbePlaces, StandASpacingApartUnlessTheyAreCounted) {
  Probe line;
  line.kind = ProbeKind::Line;
  line.from = {1, 0, 0}, line.to = {1, 0.5, 0};
  EXPECT_EQ(ProbePlaces::of(line, 0.1).count(), 6u);
  line.count = 3;
  const ProbePlaces three = ProbePlaces::of(line, 0.1);
  EXPECT_EQ(three.at(0), line.from);
  EXPECT_EQ(three.at(1), (Vec<3>{1, 0.25, 0}));
  EXPECT_EQ(three.at(2), line.to);
  Probe plane;
  plane.kind = ProbeKind::Plane;
  plane.along = {1, 0, 0}, plane.up = {0, 0, 2};
  plane.columns = 3, plane.rows = 2;
  const ProbePlaces places = ProbePlaces::of(plane, 0.1);
  EXPECT_EQ(places.count(), 6u);
  EXPECT_EQ(places.at(1), (Vec<3>{0.5, 0, 0}));
  EXPECT_EQ(places.at(5), (Vec<3>{1, 0, 2}));
}

}  // namespace
}  // namespace treacle::test
