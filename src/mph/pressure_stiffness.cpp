#include "treacle/mph/pressure_stiffness.hpp"

namespace treacle {

StiffMaterials StiffMaterials::make(const Case& c) {
  StiffMaterials table;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    table.density[m] = c.materials[m].density;
    table.viscosity[m] = c.materials[m].dynamicViscosity;
  }
  return table;
}

}  // namespace treacle
