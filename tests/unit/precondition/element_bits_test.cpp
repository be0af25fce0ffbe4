#include "treacle/precondition/element_bits.hpp"
#include "support/scene.hpp"

#include <gtest/gtest.h>

#include <random>

namespace treacle::test {
namespace {

template <int D, class Word>
void checkPacked() {
  using Bits = ElementBits<D, Word>;
  SCOPED_TRACE(testing::Message() << D << "D, " << 8 * sizeof(Word) << " bits");
  std::mt19937 random(D);
  std::uniform_real_distribution<float> real(-1, 1);
  const auto rounded = [](const Vec<D, float>& v) {
    return inUnits<D, Word>(unpackElement<D>(packElement<D, Word>(v)));
  };
  EXPECT_EQ(rounded(Vec<D, float>{}), (Vec<D, float>{}));
  double worst[D] = {};
  for (int k = 0; k < 2000; ++k) {
    Vec<D, float> v;
    for (int c = 0; c < D; ++c) v[c] = static_cast<float>(Bits::largest) * (k % 2 == 0 ? real(random) : 1.f);
    if (k % 4 == 1) v[k % D] *= -1;
    const Vec<D, float> r = rounded(v);
    EXPECT_EQ(rounded(-v), -r);
    EXPECT_EQ(rounded(r), r);
    for (int c = 0; c < D; ++c) worst[c] = std::max<double>(worst[c], std::abs(r[c] - v[c]));
  }
  for (int c = 0; c < D; ++c) {
    EXPECT_LE(worst[c], 0.501 * Bits::unitOf(c)) << "component " << c;
    EXPECT_GT(worst[c], 0.4 * Bits::unitOf(c)) << "component " << c;
  }
}

TEST(ElementBits, HoldVectorsToHalfAUnitAndTheirOppositesAlike) {
  checkPacked<2, std::uint32_t>();
  checkPacked<3, std::uint32_t>();
  checkPacked<2, std::uint64_t>();
  checkPacked<3, std::uint64_t>();
}

/// The largest elements of a scene come near to the bound, and none is beyond.
template <int D>
void checkLargest(SchemeKind scheme) {
  const Scene<D> s = makeScene<D>({.jitter = 0.4, .scheme = scheme, .slips = false});
  const MphPairs<D>& pairs = s.pairs();
  double largest = 0;
  for (std::uint32_t i = 0; i < pairs.fluidCount; ++i)
    for (std::uint32_t j = 0; j < pairs.fluidCount; ++j) {
      const Vec<D> d = pairs.difference(i, j);
      if (i == j || norm2(d) >= std::pow(pairs.terms.pressureRadius, 2)) continue;
      const Vec<D> element = pairs.terms.gradient(ExactDistance(norm2(d))) * pairs.corrected(j, d);
      for (int k = 0; k < D; ++k) largest = std::max(largest, std::abs(element[k]));
    }
  EXPECT_LE(largest, largestElement(pairs));
  EXPECT_GE(largest, 0.7 * largestElement(pairs));
}

TEST(ElementBits, NoElementIsLargerThanTheLargest) {
  for (const SchemeKind scheme : bothSchemes) {
    checkLargest<2>(scheme);
    checkLargest<3>(scheme);
  }
}

}  // namespace
}  // namespace treacle::test
