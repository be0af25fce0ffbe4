#include "picture/scale.hpp"

#include "picture/color_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

using namespace treacle;

TEST(NiceTicks, AreRoundEvenAndInside) {
  for (const double low : {0.0, -0.01, 3.7, -1234.5})
    for (const double size : {1e-9, 0.013, 1.0, 50.0, 3.3e6})
      for (const int wanted : {2, 5, 8}) {
        if (size < 1e-6 && low != 0) continue;  // not told apart in double precision to this test's accuracy
        const auto ticks = niceTicks(low, low + size, wanted);
        ASSERT_GE(ticks.size(), 2u);
        EXPECT_LE(ticks.size(), 2u * static_cast<unsigned>(wanted) + 1);
        EXPECT_GE(ticks.front(), low - 1e-6 * size);
        EXPECT_LE(ticks.back(), low + size * (1 + 1e-6));
        const double step = ticks[1] - ticks[0];
        for (std::size_t k = 1; k < ticks.size(); ++k) EXPECT_NEAR(ticks[k] - ticks[k - 1], step, 1e-6 * step);
        const double lead = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
        EXPECT_TRUE(std::abs(lead - 1) < 1e-5 || std::abs(lead - 2) < 1e-5 || std::abs(lead - 2.5) < 1e-5 ||
                    std::abs(lead - 5) < 1e-5)
            << lead;
      }
}

TEST(NiceTicks, EndWhereNumbersDo) {
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<double, double>> ranges{{0, least},        {least, 2 * least}, {-most, most},
                                                      {0, infinity},     {0, most},          {1e14, 1e14 + 0.05},
                                                      {1e17, 1e17 + 16}, {-infinity, 0},     {1, 1 + 1e-15}};
  for (const auto& [low, high] : ranges)
    for (const int wanted : {2, 9}) {
      const auto ticks = niceTicks(low, high, wanted);
      ASSERT_GE(ticks.size(), 2u);
      EXPECT_LE(ticks.size(), 20u);
      for (const double tick : ticks) EXPECT_TRUE(tick >= low && tick <= high) << tick;
    }
}

TEST(NiceTicks, ARangeWithoutWidth) { EXPECT_EQ(niceTicks(2, 2, 5), std::vector<double>{2}); }

TEST(Scale, ShowsShortNumbers) {
  EXPECT_EQ(scaleFor({0, 0.02, 0.04}, "m/s").text(0.02), "0.02");
  EXPECT_EQ(scaleFor({0, 0.02, 0.04}, "m/s").unit, "m/s");
  EXPECT_EQ(scaleFor({0, 2e-6, 4e-6}, "J").text(4e-6), "4");
  EXPECT_EQ(scaleFor({0, 2e-6, 4e-6}, "J").unit, "10⁻⁶ J");
  EXPECT_EQ(scaleFor({0, 5e4, 1e5}, "Pa").text(5e4), "50");
  EXPECT_EQ(scaleFor({0, 5e4, 1e5}, "Pa").unit, "10³ Pa");
  EXPECT_EQ(scaleFor({1, 1.005, 1.01}, "").text(1.005), "1.005");
  EXPECT_EQ(scaleFor({-0.1, -1e-17, 0.1}, "").text(-1e-17), "0.0");
  EXPECT_EQ(lengthScale(0.05, 0.01).text(0.02), "20");
  EXPECT_EQ(lengthScale(0.05, 0.01).unit, "mm");
  EXPECT_EQ(lengthScale(6, 0.5).text(1.5), "1.5");
  EXPECT_EQ(lengthScale(6, 0.5).unit, "m");
}

TEST(ColorMap, GetsLighterAllTheWay) {
  const auto lightness = [](double t) {
    const Rgb c = viridis(t);
    return 0.2126 * std::pow(c.red, 2.2) + 0.7152 * std::pow(c.green, 2.2) + 0.0722 * std::pow(c.blue, 2.2);
  };
  for (int k = 1; k <= 200; ++k) EXPECT_GT(lightness(k / 200.0), lightness((k - 1) / 200.0)) << k;
  EXPECT_EQ(viridis(-1).blue, viridis(0).blue);
  EXPECT_EQ(viridis(2).red, viridis(1).red);
  EXPECT_EQ(viridis(std::numeric_limits<double>::quiet_NaN()).red, 0.5);
}
