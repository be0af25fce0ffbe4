#include "compare/nearest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace treacle;

namespace {

std::vector<Vec<3>> randomPoints(std::size_t count, int dimensions, double from, double to, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> place(from, to);
  std::vector<Vec<3>> points(count);
  for (Vec<3>& x : points)
    for (int k = 0; k < dimensions; ++k) x[k] = place(generator);
  return points;
}

/// By looking at all points.
double leastDistance2(const std::vector<Vec<3>>& points, const Vec<3>& x, const Domain& domain) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec<3>& point : points) {
    Vec<3> d = x - point;
    for (int k = 0; k < 3; ++k)
      if (domain.periodic[k]) d[k] = std::remainder(d[k], domain.max[k] - domain.min[k]);
    least = std::min(least, norm2(d));
  }
  return least;
}

void expectNearest(const std::vector<Vec<3>>& points, const std::vector<Vec<3>>& asked, const Domain& domain) {
  const std::vector<NearestPoint> nearest = nearestPoints(asked, points, domain);
  ASSERT_EQ(nearest.size(), asked.size());
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const double expected = leastDistance2(points, asked[k], domain);
    EXPECT_NEAR(nearest[k].distance2, expected, 1e-13 * (1 + expected));
    ASSERT_LT(nearest[k].index, points.size());
    EXPECT_NEAR(leastDistance2({points[nearest[k].index]}, asked[k], domain), expected, 1e-13 * (1 + expected));
  }
}

}  // namespace

TEST(nearestPoints, areTheNearest) {
  for (const int dimensions : {2, 3})
    for (const std::size_t count : {1u, 7u, 8u, 9u, 1000u}) {
      const auto points = randomPoints(count, dimensions, 0, 1, 1);
      expectNearest(points, randomPoints(100, dimensions, 0, 1, 2), {});
      expectNearest(points, randomPoints(100, dimensions, -3, 4, 3), {});  // also beside the points
      expectNearest(points, points, {});
    }
}

TEST(nearestPoints, ofOneLayerOrOfOnePlace) {
  auto layer = randomPoints(200, 3, 0, 1, 1);
  for (Vec<3>& x : layer) x[1] = 0.5;
  expectNearest(layer, randomPoints(100, 3, 0, 1, 2), {});
  const std::vector<Vec<3>> place(50, Vec<3>{{0.1, 0.2, 0.3}});
  expectNearest(place, randomPoints(10, 3, 0, 1, 2), {});
}

TEST(nearestPoints, acrossPeriodicEnds) {
  Domain domain;
  domain.min = {{0, -1, 0}}, domain.max = {{1, 1, 2}};
  domain.periodic = {true, false, true};
  const auto points = randomPoints(300, 3, 0.05, 0.95, 1);
  expectNearest(points, randomPoints(300, 3, 0, 1, 2), domain);
  expectNearest(points, randomPoints(300, 3, -5, 5, 3), domain);  // other programs do not bring them back
}
