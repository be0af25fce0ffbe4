#include "treacle/model/materials/material_table.hpp"

#include "treacle/core/error.hpp"

#include <string>

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
    t.slipLength[i] = m.slipLength;
    for (int j = 0; j < t.count; ++j) {
      const double a = c.typicalViscosity(m), b = c.typicalViscosity(c.materials[static_cast<std::size_t>(j)]);
      t.pairViscosity[i][j] = a + b > 0 ? 2 * a * b / (a + b) : 0;
      t.pairMobility[i][j] = 4 / (m.density + c.materials[j].density);
    }
  }
  return t;
}

}  // namespace treacle
