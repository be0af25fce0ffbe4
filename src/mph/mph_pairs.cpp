#include "treacle/mph/mph_pairs.hpp"

#include <algorithm>

namespace treacle {

template <int D>
MphPairs<D> makeMphPairs(const Case& c) {
  Vec<D, bool> periodic{};
  for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[k];
  const double hp = c.pressureRadius(), hn = c.densityRadius(), hv = c.viscosityRadius();
  MphPairs<D> pairs;
  pairs.spacing = c.spacing;
  pairs.grid = CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, c.searchEdge());
  const auto pressureWeight = Weight<D>::make(hp, c.spacing, c.method.pressureWeight);
  pairs.terms = MphTerms<D>::make(pressureWeight, c.method.viscosityWeight, hv, c.spacing);
  // A lattice's sum is not quite the integral. Where B is to make the gradient exact, a full lattice needs none.
  if (c.method.pressureGradient == PressureGradient::Renormalised)
    pairs.terms.gradientFactor *= D / latticeSum<D>(hp, c.spacing, [&](double r) {
                                    return pairs.terms.gradient(ExactDistance(r * r)) * r * r;
                                  });
  pairs.terms.repulsionRadius = c.repulsionRadius();
  pairs.terms.tensionRadius = 1.25 * c.spacing;
  pairs.terms.inverseTensionRadius = 1 / pairs.terms.tensionRadius;
  const auto densityWeight = c.holdsPressures() ? DensityWeight<D>::window(hn, c.spacing)
                                                : DensityWeight<D>::make(hn, c.spacing, c.method.pressureWeight);
  pairs.terms.setDensityWeight(densityWeight);
  pairs.restDensity = latticeNumberDensity(densityWeight, c.spacing);
  pairs.ambientPressure = c.method.ambientPressure;
  pairs.materials = MaterialTable::make(c);
  pairs.classes = ViscosityClasses::make(c);
  if (c.hasOwnViscosities()) {
    pairs.ownViscosities = true;
    for (auto& row : pairs.materials.pairViscosity) std::fill(std::begin(row), std::end(row), 1.0);
  }
  return pairs;
}

template MphPairs<2> makeMphPairs<2>(const Case&);
template MphPairs<3> makeMphPairs<3>(const Case&);

}  // namespace treacle
