#include "treacle/precondition/element_bits.hpp"

#include "treacle/mph/renormalisation.hpp"

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
  const double renormalisation = pairs.slips() ? 1 / leastSlipMoment : 1;
  return 1.01 * renormalisation * largest;  // between the samples
}
template double largestElement(const MphPairs<2>&);
template double largestElement(const MphPairs<3>&);

}  // namespace treacle
