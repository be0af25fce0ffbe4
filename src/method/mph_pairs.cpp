#include "treacle/method/mph_pairs.hpp"

#include "treacle/core/error.hpp"

#include <algorithm>

namespace treacle {

MaterialTable MaterialTable::make(const Case& c) {
  MaterialTable t{};
  t.count = static_cast<int>(c.materials.size());
  if (c.materials.size() > maxMaterials)
    throw InputError("the case has " + std::to_string(t.count) + " materials; at most " +
                     std::to_string(maxMaterials) + " are possible");
  for (int i = 0; i < t.count; ++i) {
    const Material& m = c.materials[i];
    t.density[i] = m.density;
    t.inertia[i] = m.density / c.time.step;
    t.bulkViscosity[i] = m.bulkViscosity;
    t.bulkModulus[i] = m.bulkModulus;
    for (int j = 0; j < t.count; ++j) {
      const double a = m.dynamicViscosity, b = c.materials[j].dynamicViscosity;
      t.pairViscosity[i][j] = a + b > 0 ? 2 * a * b / (a + b) : 0;
      t.pairMobility[i][j] = 4 / (m.density + c.materials[j].density);
    }
  }
  return t;
}

template <int D>
MphPairs<D> makePairs(const Case& c) {
  Vec<D, bool> periodic{};
  for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[k];
  const double hp = c.pressureRadius(), hv = c.viscosityRadius();
  MphPairs<D> pairs;
  pairs.spacing = c.spacing;
  pairs.grid =
      CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, std::max(hv, 2 * hp));
  pairs.images = periodicImages(pairs.grid);
  pairs.pressureWeight = Weight<D>::make(hp, c.spacing);
  pairs.viscosityWeight = Weight<D>::make(hv, c.spacing);
  pairs.pressure = PairTerm::pressure(pairs.pressureWeight);
  pairs.viscosity = PairTerm::viscosity(pairs.viscosityWeight);
  pairs.materials = MaterialTable::make(c);
  return pairs;
}

template MphPairs<2> makePairs<2>(const Case&);
template MphPairs<3> makePairs<3>(const Case&);

}  // namespace treacle
