#include "treacle/isph/closed_regions.hpp"
#include "support/isph_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace treacle::test {
namespace {

/// The regions of fluid whose particles are within the kernel's radius of each other, without their rows: a number
/// for each particle.
template <int D>
std::vector<int> regionsOf(const IsphScene<D>& s) {
  const double radius = s.pairs.kernel.radius();
  std::vector<int> region(s.n(), -1);
  int count = 0;
  for (std::uint32_t first = 0; first < s.n(); ++first) {
    if (region[first] >= 0) continue;
    std::vector<std::uint32_t> next{first};
    region[first] = count++;
    while (!next.empty()) {
      const std::uint32_t i = next.back();
      next.pop_back();
      for (std::uint32_t j = 0; j < s.n(); ++j) {
        if (region[j] >= 0) continue;
        if (norm2(s.pairs.grid.difference(s.particles.position[i], s.particles.position[j])) >= radius * radius)
          continue;
        region[j] = region[i];
        next.push_back(j);
      }
    }
  }
  return region;
}

template <int D>
void checkRegions(unsigned seed, const Vec<D>& gravity) {
  IsphScene<D> s = makeRegions<D>(seed);
  s.pairs.frame.gravity = gravity;
  const std::vector<int> region = regionsOf(s);
  std::set<int> open;
  for (std::uint32_t i = 0; i < s.n(); ++i)
    if (s.surface[i]) open.insert(region[i]);
  ClosedRegions<Cpu> closed;
  findClosedRegions(s.context, s.pairs, s.surface.span(), closed);
  EXPECT_TRUE(std::ranges::is_sorted(closed.labels));
  std::map<int, std::uint32_t> labels;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    if (open.contains(region[i])) {
      ASSERT_EQ(closed.label[i], 0u);
      continue;
    }
    ASSERT_TRUE(std::ranges::binary_search(closed.labels, closed.label[i]));
    ASSERT_EQ(labels.try_emplace(region[i], closed.label[i]).first->second, closed.label[i]);
  }
  EXPECT_EQ(labels.size(), closed.labels.size());
  EXPECT_GE(labels.size(), 2u);
  EXPECT_GE(open.size(), 2u);

  std::vector<double> x = randomNumbers(s.n(), 4);
  const std::vector<double> before = x;
  std::map<std::uint32_t, std::vector<double>> values;
  for (const Level level : {Level::Mean, Level::Least}) {
    takeLevels(s.context, closed, level, std::span(x));
    values.clear();
    for (std::uint32_t i = 0; i < s.n(); ++i) {
      if (closed.label[i] == 0) {
        ASSERT_EQ(x[i], before[i]);
      }
      values[closed.label[i]].push_back(x[i]);
    }
    for (const std::uint32_t label : closed.labels) {
      double sum = 0;
      for (const double value : values[label]) sum += value;
      if (level == Level::Mean) {
        EXPECT_NEAR(sum, 0, 1e-12);
      } else {
        EXPECT_EQ(std::ranges::min(values[label]), 0);
      }
    }
  }

  std::vector<float> missing(s.n(), 0.05f);
  fillRegions(s.context, closed, std::span(missing));
  for (std::uint32_t i = 0; i < s.n(); ++i) ASSERT_EQ(missing[i], closed.label[i] ? 0.0f : 0.05f);
}

TEST(ClosedRegions, AreThoseWithoutASurface) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    checkRegions<2>(seed, {});
    checkRegions<2>(seed, {0, -9.81});
    checkRegions<2>(seed, {-3, 1});
    checkRegions<3>(seed, {0, 0, -9.81});
  }
}

TEST(ClosedRegions, ThereAreNoneBelowASurface) {
  IsphScene<2> s = makeIsphScene<2>();
  for (std::uint32_t i = 0; i < s.n(); ++i) s.surface[i] = Place::Surface;
  ClosedRegions<Cpu> closed;
  findClosedRegions(s.context, s.pairs, s.surface.span(), closed);
  EXPECT_FALSE(closed.some());
  std::vector<double> x = randomNumbers(s.n(), 1);
  const std::vector<double> before = x;
  takeLevels(s.context, closed, Level::Mean, std::span(x));
  EXPECT_EQ(x, before);
}

}  // namespace
}  // namespace treacle::test
