#include "point_tree.hpp"

#include "treacle/core/vec.hpp"

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

void expectNearest(const std::vector<Vec<3>>& points, const std::vector<Vec<3>>& asked, int dimensions,
                   const Domain& domain) {
  const PointTree tree(points, dimensions, domain);
  for (const Vec<3>& x : asked) {
    const auto nearest = tree.nearest(x);
    const double expected = leastDistance2(points, x, domain);
    EXPECT_NEAR(nearest.distance2, expected, 1e-13 * (1 + expected));
    ASSERT_LT(nearest.index, points.size());
    EXPECT_NEAR(leastDistance2({points[nearest.index]}, x, domain), expected, 1e-13 * (1 + expected));
  }
}

}  // namespace

TEST(PointTree, FindsTheNearestPoint) {
  for (const int dimensions : {2, 3})
    for (const std::size_t count : {1u, 7u, 8u, 9u, 1000u}) {
      const auto points = randomPoints(count, dimensions, 0, 1, 1);
      expectNearest(points, randomPoints(100, dimensions, 0, 1, 2), dimensions, {});
      expectNearest(points, randomPoints(100, dimensions, -3, 4, 3), dimensions, {});  // also beside the points
      expectNearest(points, points, dimensions, {});
    }
}

TEST(PointTree, PointsOfOneLayerOrOfOnePlace) {
  auto layer = randomPoints(200, 3, 0, 1, 1);
  for (Vec<3>& x : layer) x[1] = 0.5;
  expectNearest(layer, randomPoints(100, 3, 0, 1, 2), 3, {});
  const std::vector<Vec<3>> place(50, Vec<3>{{0.1, 0.2, 0.3}});
  expectNearest(place, randomPoints(10, 3, 0, 1, 2), 3, {});
}

TEST(PointTree, AcrossPeriodicEnds) {
  Domain domain;
  domain.min = {{0, -1, 0}}, domain.max = {{1, 1, 2}};
  domain.periodic = {true, false, true};
  const auto points = randomPoints(300, 3, 0.05, 0.95, 1);
  expectNearest(points, randomPoints(300, 3, 0, 1, 2), 3, domain);
  expectNearest(points, randomPoints(300, 3, -5, 5, 3), 3, domain);  // other programs do not bring them back
}
