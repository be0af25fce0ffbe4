#include "treacle/search/hilbert.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace treacle {
namespace {

template <int D>
void checkCurve(int bits) {
  const std::uint32_t side = 1u << bits;
  const std::size_t points = D == 2 ? std::size_t{side} * side : std::size_t{side} * side * side;
  std::vector<Vec<D, std::uint32_t>> order(points);
  std::vector<int> visits(points, 0);
  for (std::size_t p = 0; p < points; ++p) {
    Vec<D, std::uint32_t> x{};
    std::size_t rest = p;
    for (int k = 0; k < D; ++k, rest /= side) x[k] = static_cast<std::uint32_t>(rest % side);
    const std::uint64_t index = hilbertIndex<D>(x, bits);
    ASSERT_LT(index, points);
    ++visits[index];
    order[index] = x;
  }
  for (int v : visits) ASSERT_EQ(v, 1);
  for (std::size_t i = 1; i < points; ++i) {
    int distance = 0;
    for (int k = 0; k < D; ++k) distance += std::abs(int(order[i][k]) - int(order[i - 1][k]));
    ASSERT_EQ(distance, 1) << "step " << i;
  }
  // Every run of (2^D)^k points is an aligned block of 2^k points per axis.
  for (int k = 1; k < bits; ++k)
    for (std::size_t i = 0; i < points; ++i) {
      const std::size_t first = i >> (D * k) << (D * k);
      for (int a = 0; a < D; ++a) ASSERT_EQ(order[i][a] >> k, order[first][a] >> k);
    }
}

TEST(Hilbert, VisitsEveryPointOnceInUnitStepsAndBlockByBlock) {
  checkCurve<2>(1);
  checkCurve<2>(5);
  checkCurve<3>(1);
  checkCurve<3>(4);
}

}  // namespace
}  // namespace treacle
