#include "treacle/precondition/packed_tensor.hpp"
#include "treacle/mph/renormalisation.hpp"

#include <gtest/gtest.h>

#include <random>

namespace treacle::test {
namespace {

template <int D>
SymmetricBlock<D> rounded(const SymmetricBlock<D>& b) {
  using Packed = PackedTensor<D>;
  return 1.0 / Packed::scale * Packed::unpack(Packed::pack(b));
}

template <int D>
void checkPacked() {
  const SymmetricBlock<D> unit = SymmetricBlock<D>::identity();
  for (int e = 0; e < unit.size; ++e) EXPECT_EQ(rounded(unit).a[e], unit.a[e]) << "element " << e;

  std::mt19937 random(D);
  std::uniform_real_distribution<double> real(-1, 1);
  double largestError = 0;
  for (int k = 0; k < 1000; ++k) {
    SymmetricBlock<D> moment{};
    for (int n = 0; n < 12; ++n) {
      Vec<D> v;
      for (int c = 0; c < D; ++c) v[c] = real(random);
      moment.addOuter(k < 500 ? 0.4 : 0.05, v);
    }
    const SymmetricBlock<D> b = renormalisationOf(moment), once = rounded(b), twice = rounded(once);
    for (int e = 0; e < b.size; ++e) {
      largestError = std::max(largestError, std::abs(once.a[e] - b.a[e]));
      EXPECT_EQ(twice.a[e], once.a[e]);
    }
  }
  EXPECT_GT(largestError, 0.4 / PackedTensor<D>::scale);
  EXPECT_LE(largestError, 0.5001 / PackedTensor<D>::scale);
}

TEST(PackedTensor, HasEveryElementToHalfALevel) {
  checkPacked<2>();
  checkPacked<3>();
}

}  // namespace
}  // namespace treacle::test
