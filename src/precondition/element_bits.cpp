#include "treacle/precondition/element_bits.hpp"

#include <algorithm>

namespace treacle {

template <int D>
double largestElement(const MphPairs<D>& pairs) {
  constexpr int samples = 1000;
  double largest = 0;
  for (int k = 0; k < samples; ++k) {
    const double r = pairs.terms.pressureRadius * (k + 0.5) / samples;
    largest = std::max(largest, pairs.terms.gradient(ExactDistance(r * r)) * r);
  }
  return 1.01 * largest;  // between the samples
}
template double largestElement(const MphPairs<2>&);
template double largestElement(const MphPairs<3>&);

}  // namespace treacle
