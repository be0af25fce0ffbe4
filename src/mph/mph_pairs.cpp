#include "treacle/mph/mph_pairs.hpp"

#include <algorithm>
#include <limits>

namespace treacle {
namespace {

/// The pressures of surfaces with a surface tension were found with the weight of pressures and 3 spacings
/// (docs/surface-tension.md); the window leaves currents in drops at rest.
template <int D>
Weight<D> densityWeightOf(const Case& c) {
  if (c.keepsVolume()) return Weight<D>::make(c.densityRadius(), c.spacing, WeightShape::DensityWindow);
  if (c.isAccurate()) return Weight<D>::make(3 * c.spacing, c.spacing, WeightShape::Wendland);
  return Weight<D>::make(c.densityRadius(), c.spacing, WeightShape::Published);
}

}  // namespace

template <int D>
MphPairs<D> makeMphPairs(const Case& c) {
  Vec<D, bool> periodic{};
  for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[k];
  const double hp = c.pressureRadius(), hv = c.viscosityRadius();
  MphPairs<D> pairs;
  pairs.spacing = c.spacing;
  pairs.grid = CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, c.searchEdge());
  pairs.terms = MphTerms<D>::make(c.method.scheme, hp, hv, c.spacing);
  // A lattice's sum is not quite the integral. Where B is to make the gradient exact, a full lattice needs none.
  if (c.isAccurate())
    pairs.terms.gradientFactor *= D / latticeSum<D>(hp, c.spacing, [&](double r) {
                                    return pairs.terms.gradient(ExactDistance(r * r)) * r * r;
                                  });
  pairs.terms.repulsionRadius = c.repulsionRadius();
  const auto densityWeight = densityWeightOf<D>(c);
  pairs.terms.setDensityWeight(densityWeight);
  pairs.restDensity = latticeNumberDensity(densityWeight, c.spacing);
  pairs.wideScale = 1 / latticeSum<D>(densityWeight.radius, c.spacing,
                                      [&](double r) { return pairs.terms.openness(ExactDistance(r * r)); });
  pairs.background = c.method.backgroundPressure;
  pairs.tensionLimit = c.method.tensionLimit > 0 ? c.method.tensionLimit : std::numeric_limits<double>::infinity();
  pairs.materials = MaterialTable::make(c);
  pairs.classes = ViscosityClasses::make(c);
  pairs.smoothWalls = c.hasSmoothWalls();
  if (c.hasOwnViscosities()) {
    pairs.ownViscosities = true;
    for (auto& row : pairs.materials.pairViscosity) std::fill(std::begin(row), std::end(row), 1.0);
  }
  return pairs;
}

template MphPairs<2> makeMphPairs<2>(const Case&);
template MphPairs<3> makeMphPairs<3>(const Case&);

}  // namespace treacle
