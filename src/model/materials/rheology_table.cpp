#include "treacle/model/materials/rheology_table.hpp"

namespace treacle {

RheologyTable RheologyTable::make(const Case& c, std::vector<FormulaStep>& steps) {
  RheologyTable table;
  table.states = StateTable::make(c, steps);
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    const Material& material = c.materials[m];
    table.of[m] = material.rheology.value_or(Rheology::newtonian(material.dynamicViscosity));
    if (material.viscosityShift) table.shift[m] = ShiftFactor::make(*material.viscosityShift);
    if (material.freezing) table.frozen[m] = FrozenShare::make(*material.freezing);
  }
  return table;
}

}  // namespace treacle
