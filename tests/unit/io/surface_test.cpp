#include "surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace treacle;

TEST(Surface, OfABallIsRadial) {
  constexpr double spacing = 1e-3, radius = 12e-3;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> shift(-0.1 * spacing, 0.1 * spacing);
  const Vec<3> center{0.1, -0.2, 0.3};
  std::vector<Vec<3>> position;
  for (int a = -13; a <= 13; ++a)
    for (int b = -13; b <= 13; ++b)
      for (int c = -13; c <= 13; ++c) {
        const Vec<3> x{a * spacing + shift(generator), b * spacing + shift(generator),
                       c * spacing + shift(generator)};
        if (norm(x) < radius) position.push_back(center + x);
      }
  const auto points = surfacePoints(position, spacing);
  ASSERT_EQ(points.size(), position.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec<3> x = position[i] - center;
    if (norm(x) < radius - 5 * spacing) {
      EXPECT_EQ(norm(points[i].normal), 0);
    } else if (norm(x) > radius - 0.7 * spacing) {
      EXPECT_NEAR(norm(points[i].normal), 1, 1e-12);
      EXPECT_GT(dot(points[i].normal, x) / norm(x), 0.95);
      EXPECT_TRUE(points[i].outermost);
    } else if (norm(x) < radius - 2.5 * spacing) {
      EXPECT_FALSE(points[i].outermost);
    }
  }
}

TEST(Surface, FarApartParticlesDoNotNeedAGridOfEverything) {
  const std::vector<Vec<3>> position{{0, 0, 0}, {1e3, -1e3, 1e3}, {5, 5, 5}};
  EXPECT_EQ(surfacePoints(position, 1e-3).size(), 3u);
}
