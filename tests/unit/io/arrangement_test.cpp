#include "treacle/io/frames/arrangement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace treacle;

namespace {

constexpr double latticeSpacing = 2e-3;  // [m]

Frame frameOf(int dimensions, std::vector<Vec<3>> position) {
  Frame frame;
  frame.dimensions = dimensions;
  frame.position = std::move(position);
  return frame;
}

/// `side` particles along each axis, the first one half a spacing from `corner` on each.
std::vector<Vec<3>> lattice(int dimensions, int side, Vec<3> corner = {}, double stretch = 1) {
  std::vector<Vec<3>> points;
  for (int z = 0; z < (dimensions == 3 ? side : 1); ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const Vec<3> cell{x + 0.5, y + 0.5, dimensions == 3 ? z + 0.5 : 0.0};
        points.push_back(corner + cell * (stretch * latticeSpacing));
      }
  return points;
}

std::vector<Vec<3>> randomPoints(int dimensions, std::size_t count, double side, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> place(0, side);
  std::vector<Vec<3>> points(count);
  for (Vec<3>& x : points)
    for (int k = 0; k < dimensions; ++k) x[k] = place(generator);
  return points;
}

Domain periodicBox(double side, std::array<bool, 3> periodic) { return {{}, Vec<3>::filled(side), periodic}; }

/// By looking at all pairs and images.
std::vector<double> slowDistances(const Frame& fluid, const Frame& walls, const Domain& domain) {
  std::vector<Vec<3>> all = fluid.position;
  all.insert(all.end(), walls.position.begin(), walls.position.end());
  std::vector<double> distances;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    double least = nearestReach;
    for (std::size_t j = 0; j < all.size(); ++j) {
      Vec<3> d = all[j] - all[i];
      for (int k = 0; k < 3; ++k)
        if (domain.periodic[static_cast<std::size_t>(k)])
          d[k] = std::remainder(d[k], domain.max[k] - domain.min[k]);
      if (j != i) least = std::min(least, norm(d) / latticeSpacing);
    }
    distances.push_back(least);
  }
  return distances;
}

}  // namespace

TEST(Arrangement, LatticeHasDistancesAndADensityOfOne) {
  for (const int dimensions : {2, 3}) {
    Frame fluid = frameOf(dimensions, lattice(dimensions, 12));
    const Arrangement a = measureArrangement(fluid, frameOf(dimensions, {}), {}, latticeSpacing);
    ASSERT_EQ(fluid.nearestDistance.size(), fluid.position.size());
    for (const double distance : fluid.nearestDistance) ASSERT_NEAR(distance, 1, 1e-12);
    EXPECT_NEAR(a.least, 1, 1e-12);
    EXPECT_NEAR(a.low, 1, 1e-12);
    EXPECT_EQ(a.close, 0);
    ASSERT_TRUE(a.density);
    EXPECT_NEAR(*a.density, 1, 1e-4);
  }
}

TEST(Arrangement, DensityIsThatOfAStretchedLattice) {
  for (const int dimensions : {2, 3})
    for (const double stretch : {0.97, 0.99, 1.01, 1.03}) {
      Frame fluid = frameOf(dimensions, lattice(dimensions, 20, {0.3e-3, 0.7e-3, 0}, stretch));
      const Arrangement a = measureArrangement(fluid, frameOf(dimensions, {}), {}, latticeSpacing);
      EXPECT_NEAR(a.least, stretch, 1e-12);
      ASSERT_TRUE(a.density);
      EXPECT_NEAR(*a.density * std::pow(stretch, dimensions), 1, 5e-4);
    }
}

/// Every other row is moved into its neighbours, as far as 0.1 spacings: the fluid is as dense as before.
TEST(Arrangement, DensityDoesNotTakeClumpsForDenseFluid) {
  Frame fluid = frameOf(2, lattice(2, 40));
  for (std::size_t i = 0; i < fluid.position.size(); i += 2) fluid.position[i][0] += 0.9 * latticeSpacing;
  const Arrangement a = measureArrangement(fluid, frameOf(2, {}), {}, latticeSpacing);
  EXPECT_NEAR(a.low, 0.1, 1e-9);
  ASSERT_TRUE(a.density);
  EXPECT_NEAR(*a.density, 1, 2e-3);
}

TEST(Arrangement, DensityIsUnknownWhereNoPlaceIsInsideTheFluid) {
  const Domain open;
  Frame layer = frameOf(2, lattice(2, 6));
  EXPECT_FALSE(measureArrangement(layer, frameOf(2, {}), open, latticeSpacing).density);
  // Between two periodic ends there is no surface; in the middle of the fluid there may be a wall.
  Frame full = frameOf(2, lattice(2, 6));
  EXPECT_TRUE(
      measureArrangement(full, frameOf(2, {}), periodicBox(6 * latticeSpacing, {true, true}), latticeSpacing)
          .density);
  const Frame wall = frameOf(2, {Vec<3>{3 * latticeSpacing, 3 * latticeSpacing, 0}});
  EXPECT_FALSE(
      measureArrangement(full, wall, periodicBox(6 * latticeSpacing, {true, true}), latticeSpacing).density);
}

TEST(Arrangement, TwoParticles) {
  for (const int dimensions : {2, 3})
    for (const double distance : {0.0, 0.25, 1.4, 1.6, 1e7}) {
      Frame fluid = frameOf(dimensions, {Vec<3>{-1, 2, 0}, Vec<3>{-1 + 0.6 * distance * latticeSpacing,
                                                                  2 - 0.8 * distance * latticeSpacing, 0}});
      const Arrangement a = measureArrangement(fluid, frameOf(dimensions, {}), {}, latticeSpacing);
      for (const double found : fluid.nearestDistance)
        EXPECT_NEAR(found, std::min(distance, nearestReach), 1e-9 * (1 + distance));
      EXPECT_EQ(a.least, std::min(fluid.nearestDistance[0], fluid.nearestDistance[1]));
      EXPECT_EQ(a.low, a.least);
      EXPECT_FALSE(a.density);
    }
}

TEST(Arrangement, AcrossAPeriodicBoundaryAndItsCorner) {
  const double side = 10 * latticeSpacing, e = 0.3 * latticeSpacing;
  Frame fluid = frameOf(3, {Vec<3>{e, e, e}, Vec<3>{side - e, side - e, e}});
  measureArrangement(fluid, frameOf(3, {}), periodicBox(side, {true, true, false}), latticeSpacing);
  for (const double distance : fluid.nearestDistance) EXPECT_NEAR(distance, 0.6 * std::sqrt(2), 1e-12);
  measureArrangement(fluid, frameOf(3, {}), periodicBox(side, {true, false, false}), latticeSpacing);
  for (const double distance : fluid.nearestDistance) EXPECT_EQ(distance, nearestReach);
}

TEST(Arrangement, NextToAWall) {
  Frame fluid = frameOf(2, {Vec<3>{0, 0.4 * latticeSpacing, 0}, Vec<3>{5 * latticeSpacing, 0, 0}});
  const Frame walls = frameOf(2, {Vec<3>{0, -0.3 * latticeSpacing, 0}, Vec<3>{0, -0.35 * latticeSpacing, 0}});
  const Arrangement a = measureArrangement(fluid, walls, {}, latticeSpacing);
  EXPECT_NEAR(fluid.nearestDistance[0], 0.7, 1e-12);
  EXPECT_EQ(fluid.nearestDistance[1], nearestReach);
  EXPECT_NEAR(a.least, 0.7, 1e-12) << "distances between wall particles do not count";
}

TEST(Arrangement, OfRandomParticlesIsWhatAllPairsSay) {
  for (const int dimensions : {2, 3}) {
    const double side = dimensions == 2 ? 40 * latticeSpacing : 12 * latticeSpacing;
    for (const bool periodic : {false, true}) {
      Frame fluid = frameOf(dimensions, randomPoints(dimensions, 1500, side, 1));
      const Frame walls = frameOf(dimensions, randomPoints(dimensions, 200, side, 2));
      const Domain domain = periodicBox(side, {periodic, periodic, periodic && dimensions == 3});
      const Arrangement a = measureArrangement(fluid, walls, domain, latticeSpacing);
      std::vector<double> expected = slowDistances(fluid, walls, domain);
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(fluid.nearestDistance[i], expected[i], 1e-12) << "particle " << i;
      std::sort(expected.begin(), expected.end());
      EXPECT_NEAR(a.least, expected[0], 1e-12);
      EXPECT_NEAR(a.low, expected[14], 1e-12);
      const auto notClose = std::lower_bound(expected.begin(), expected.end(), closeDistance);
      EXPECT_NEAR(a.close, (notClose - expected.begin()) / 1500.0, 1e-12);
      EXPECT_GT(a.close, 0.05);
    }
  }
}

/// The fluid cut across x into parts, each of which knows what is within `reach` [spacings] of it, from whichever
/// side of periodic ends.
struct Parts {
  std::vector<Frame> fluid;
  std::vector<std::vector<std::size_t>> index;  // of the part's particles in the whole
  std::vector<std::vector<Vec<3>>> others;

  Parts(const Frame& whole, const Frame& walls, const Domain& domain, double side, std::size_t count, double reach)
      : fluid(count), index(count), others(count) {
    const auto partOf = [&](const Vec<3>& x) {
      return std::min(static_cast<std::size_t>(x[0] / side * static_cast<double>(count)), count - 1);
    };
    const auto isNear = [&](const Vec<3>& x, std::size_t part) {
      const double middle = (static_cast<double>(part) + 0.5) * side / static_cast<double>(count);
      const double d = domain.periodic[0] ? std::remainder(x[0] - middle, side) : x[0] - middle;
      return std::abs(d) < side / static_cast<double>(2 * count) + reach * latticeSpacing;
    };
    for (std::size_t part = 0; part < count; ++part) {
      fluid[part].dimensions = whole.dimensions;
      for (std::size_t i = 0; i < whole.position.size(); ++i) {
        if (partOf(whole.position[i]) == part)
          fluid[part].position.push_back(whole.position[i]), index[part].push_back(i);
        else if (isNear(whole.position[i], part))
          others[part].push_back(whole.position[i]);
      }
      for (const Vec<3>& x : walls.position)
        if (isNear(x, part)) others[part].push_back(x);
    }
  }

  ArrangementPart sum(const Domain& domain) {
    ArrangementPart all = measureArrangementPart(fluid[0], others[0], domain, latticeSpacing);
    for (std::size_t k = 1; k < fluid.size(); ++k) {
      const ArrangementPart part = measureArrangementPart(fluid[k], others[k], domain, latticeSpacing);
      all.least = std::min(all.least, part.least);
      all.density += part.density, all.places += part.places, all.close += part.close;
      for (std::size_t b = 0; b < all.distances.size(); ++b) all.distances[b] += part.distances[b];
    }
    return all;
  }
};

TEST(Arrangement, PartsMakeThatOfTheWhole) {
  for (const int dimensions : {2, 3}) {
    const double side = dimensions == 2 ? 40 * latticeSpacing : 12 * latticeSpacing;
    for (const bool periodic : {false, true}) {
      const Domain domain = periodicBox(side, {periodic, periodic, periodic && dimensions == 3});
      Frame fluid = frameOf(dimensions, randomPoints(dimensions, 1500, side, 1));
      const Frame walls = frameOf(dimensions, randomPoints(dimensions, 200, side, 2));
      const Arrangement expected = measureArrangement(fluid, walls, domain, latticeSpacing);
      Parts parts(fluid, walls, domain, side, 3, nearestReach);
      const Arrangement found = arrangementOf(parts.sum(domain));
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < parts.index[k].size(); ++i)
          ASSERT_EQ(parts.fluid[k].nearestDistance[i], fluid.nearestDistance[parts.index[k][i]]);
      EXPECT_EQ(found.least, expected.least);
      EXPECT_NEAR(found.low, expected.low, ArrangementPart::bin / 2);
      EXPECT_EQ(found.close, expected.close);
    }
  }
}

TEST(Arrangement, DensityOfPartsIsThatOfTheWhole) {
  for (const int dimensions : {2, 3})
    for (const double stretch : {0.97, 1.0, 1.03}) {
      const Frame whole = frameOf(dimensions, lattice(dimensions, 26, {0.3e-3, 0.7e-3, 0}, stretch));
      const double side = 26 * stretch * latticeSpacing;
      // What one search cell brings is less than a place looks at.
      Parts parts(whole, frameOf(dimensions, {}), {}, side, 2, 2.1);
      const ArrangementPart sum = parts.sum({});
      const Arrangement found = arrangementOf(sum);
      ASSERT_TRUE(found.density);
      EXPECT_NEAR(*found.density * std::pow(stretch, dimensions), 1, 1e-3) << dimensions << ' ' << stretch;
      EXPECT_NEAR(found.least, stretch, 1e-12);
      EXPECT_NEAR(found.low, stretch, ArrangementPart::bin);
    }
}

TEST(Arrangement, OfAPartWithoutParticles) {
  Frame none = frameOf(2, {});
  const ArrangementPart part = measureArrangementPart(none, lattice(2, 3), {}, latticeSpacing);
  EXPECT_EQ(arrangementOf(part), Arrangement{});
  EXPECT_FALSE(part.distances.empty()) << "all processes add up equally many";
}

TEST(Arrangement, TellsWhetherFluidTouchesWallsAndHowFarTheyAre) {
  const Domain domain = periodicBox(20 * latticeSpacing, {true, false});
  for (const double gap : {1.4, 1.6}) {
    Frame fluid = frameOf(2, {Vec<3>{0.2 * latticeSpacing, 0, 0}});
    const Frame walls = frameOf(2, {Vec<3>{(20.2 - gap) * latticeSpacing, 0, 0}});
    EXPECT_EQ(measureArrangement(fluid, walls, domain, latticeSpacing).touchesWalls, gap < nearestReach);
    EXPECT_NEAR(distanceToWalls(fluid, walls, domain), gap * latticeSpacing, 1e-12);
    EXPECT_FALSE(measureArrangement(fluid, frameOf(2, {}), domain, latticeSpacing).touchesWalls);
    EXPECT_EQ(distanceToWalls(fluid, frameOf(2, {}), domain), std::numeric_limits<double>::infinity());
  }
}

/// Also particles that lie nowhere: what is written of a run that failed must not end the program.
TEST(Arrangement, OfNoParticlesAndOfPositionsThatAreNotFinite) {
  Frame none = frameOf(2, {});
  EXPECT_EQ(measureArrangement(none, frameOf(2, lattice(2, 3)), {}, latticeSpacing), Arrangement{});
  EXPECT_TRUE(none.nearestDistance.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    Frame fluid = frameOf(2, {Vec<3>{0, 0, 0}, Vec<3>{bad, 0, 0}, Vec<3>{0.5 * latticeSpacing, 0, 0}});
    measureArrangement(fluid, frameOf(2, {}), {}, latticeSpacing);
    EXPECT_EQ(fluid.nearestDistance.size(), 3u);
  }
}
