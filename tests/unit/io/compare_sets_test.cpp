#include "treacle/io/compare/compare_sets.hpp"

#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace treacle;
using namespace treacle::test;

namespace {

/// Particles 1 m apart in a rectangle of 4 x 3, from the origin on, that turn about it at 1 rad/s.
Frame rectangle() {
  Frame f;
  f.dimensions = 2;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      f.position.push_back({{double(i), double(j)}});
      f.velocity.push_back({{-double(j), double(i)}});
      f.pressure.push_back(10.0 * i);
    }
  return f;
}

Case setCase() {
  Case c;
  c.spacing = 1;
  c.domain.max = {{10, 10}};
  return c;
}

const SetMeasure& find(const SetDifference& d, const std::string& name) {
  for (const SetMeasure& m : d.measures)
    if (m.name == name) return m;
  throw std::out_of_range(name);
}

bool holds(const SetDifference& d, const std::string& name) {
  return std::any_of(d.measures.begin(), d.measures.end(), [&](const SetMeasure& m) { return m.name == name; });
}

}  // namespace

TEST(CompareSets, ASetInAnotherOrderDoesNotDiffer) {
  for (const int dimensions : {2, 3}) {
    const Frame b = sampleFrame(dimensions, 500);
    Frame a = b;
    std::reverse(a.position.begin(), a.position.end()), std::reverse(a.velocity.begin(), a.velocity.end());
    std::reverse(a.pressure.begin(), a.pressure.end());
    std::reverse(a.numberDensity.begin(), a.numberDensity.end());
    std::reverse(a.nearestDistance.begin(), a.nearestDistance.end());
    const SetDifference d = compareSets(a, b, setCase());
    for (const auto& field : d.nearest.fields) {
      ASSERT_TRUE(field);
      EXPECT_EQ(field->maximum, 0);
      EXPECT_EQ(field->relative, 0);
    }
    for (const SetMeasure& m : d.measures)
      EXPECT_LT(m.relative.value_or(0), 1e-14) << m.name;  // sums in another order
    EXPECT_EQ(holds(d, "max_z"), dimensions == 3);
  }
}

TEST(CompareSets, AMovedSet) {
  Frame a = rectangle();
  for (Vec<3>& x : a.position) x += Vec<3>{{0.3, -0.4}};
  for (Vec<3>& u : a.velocity) u += Vec<3>{{0, 2}};
  const SetDifference d = compareSets(a, rectangle(), setCase());
  EXPECT_EQ(find(d, "particles").a, 12);
  EXPECT_EQ(find(d, "particles").difference, 0);
  EXPECT_DOUBLE_EQ(*find(d, "max_x").a, 3.3);
  EXPECT_EQ(find(d, "max_x").b, 3);
  EXPECT_NEAR(*find(d, "max_x").relative, 0.3 / 4, 1e-12);  // the rectangle is 3 m and one spacing long
  EXPECT_DOUBLE_EQ(*find(d, "min_y").a, -0.4);
  EXPECT_NEAR(*find(d, "center_y").difference, 0.4, 1e-12);
  EXPECT_EQ(find(d, "center_x").b, 1.5);
  EXPECT_NEAR(*find(d, "mean_velocity_y").difference, 2, 1e-12);
  EXPECT_NEAR(*find(d, "mean_velocity_x").difference, 0, 1e-12);
  // Mean of i^2 over 0..3 is 3.5, of j^2 over 0..2 is 5/3; with i + 2 instead it is 13.5.
  EXPECT_NEAR(*find(d, "kinetic_energy").a, (13.5 + 5 / 3.0) / 2, 1e-12);
  EXPECT_NEAR(*find(d, "kinetic_energy").b, (3.5 + 5 / 3.0) / 2, 1e-12);
  // Nobody is nearer than the particle that each comes from.
  for (const char* name : {"nearest_mean", "nearest_rms", "nearest_max"}) {
    EXPECT_NEAR(*find(d, name).a, 0.5, 1e-12);
    EXPECT_NEAR(*find(d, name).b, 0.5, 1e-12);
  }
  EXPECT_NEAR(d.nearest[ComparedField::Position]->relative, 0.5 / 4, 1e-12);
  EXPECT_NEAR(d.nearest[ComparedField::Velocity]->rms, 2, 1e-12);
  EXPECT_NEAR(d.nearest[ComparedField::Velocity]->relative, 2 / std::sqrt(3.5 + 5 / 3.0), 1e-12);
  EXPECT_EQ(d.nearest[ComparedField::Pressure]->maximum, 0);
  EXPECT_FALSE(d.nearest[ComparedField::NumberDensity]);
  EXPECT_FALSE(holds(d, "number_density_rms"));
}

TEST(CompareSets, WhatOnlyTheReferenceHasCounts) {
  Frame a = rectangle();
  a.position.resize(8), a.velocity.resize(8), a.pressure.resize(8);  // without the upper row
  const SetDifference d = compareSets(a, rectangle(), setCase());
  EXPECT_EQ(find(d, "particles").difference, 4);
  EXPECT_DOUBLE_EQ(*find(d, "particles").relative, 4 / 12.0);
  EXPECT_EQ(find(d, "nearest_max").a, 0);
  EXPECT_EQ(find(d, "nearest_max").b, 1);
  EXPECT_DOUBLE_EQ(*find(d, "nearest_mean").b, 1 / 3.0);
  EXPECT_DOUBLE_EQ(d.nearest[ComparedField::Position]->rms, std::sqrt(1 / 3.0));
  EXPECT_EQ(d.nearest[ComparedField::Position]->maximum, 1);
  EXPECT_EQ(d.nearest[ComparedField::Velocity]->maximum, 0);
  // The other way round it is a's velocities that are held against b's lower rows.
  EXPECT_EQ(compareSets(rectangle(), a, setCase()).nearest[ComparedField::Velocity]->maximum, 1);
}

TEST(CompareSets, AcrossPeriodicEnds) {
  Frame a = rectangle(), b = rectangle();
  a.position[0][0] = 10 - 0.25, b.position[0][0] = 0.25;
  Case c = setCase();
  EXPECT_NEAR(*find(compareSets(a, b, c), "nearest_max").a, 6.75, 1e-12);
  c.domain.periodic[0] = true;
  const SetDifference d = compareSets(a, b, c);
  EXPECT_NEAR(*find(d, "nearest_max").a, 0.5, 1e-12);
  EXPECT_FALSE(holds(d, "max_x"));  // has no meaning there
  EXPECT_TRUE(holds(d, "max_y"));
  EXPECT_TRUE(holds(d, "mean_velocity_x"));
}

TEST(CompareSets, NotANumberShows) {
  Frame a = rectangle();
  a.velocity[5][0] = std::nan("");
  const SetDifference d = compareSets(a, rectangle(), setCase());
  EXPECT_TRUE(std::isnan(d.nearest[ComparedField::Velocity]->relative));
  EXPECT_TRUE(std::isnan(d.nearest[ComparedField::Velocity]->maximum));
}

TEST(CompareSets, RefusesWhatIsNoSet) {
  const auto message = [](const Frame& a) {
    return messageOf<InputError>([&] { compareSets(a, rectangle(), setCase()); });
  };
  Frame a = rectangle();
  a.dimensions = 3;
  EXPECT_EQ(message(a), "3 and 2 dimensions");
  a = rectangle();
  a.position[3][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message(a), "a position is not finite");
  Frame empty;
  empty.dimensions = 2;
  EXPECT_EQ(message(empty), "no particles in one of them");
}

TEST(WriteSetMeasures, FormatIsFixed) {
  TemporaryDirectory directory;
  const std::vector<SetMeasure> measures{{"particles", "", 8, 12, 4, 0.5}, {"nearest_max", "m", 0.25, 1, {}, {}}};
  writeSetMeasures(directory / "table.csv", measures);
  EXPECT_EQ(content(directory / "table.csv"),
            "measure,unit,a,b,difference,relative\nparticles,,8,12,4,0.5\nnearest_max,m,0.25,1,,\n");
}
