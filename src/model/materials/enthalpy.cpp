#include "treacle/model/materials/enthalpy.hpp"

namespace treacle {

Enthalpy Enthalpy::make(const Material& m) {
  Enthalpy e;
  e.liquid = e.solid = e.between = m.density * m.specificHeat;
  e.liquidConductivity = e.solidConductivity = m.conductivity;
  if (!m.freezing) return e;
  const Freezing& f = *m.freezing;
  e.frozen = FrozenShare::make(f);
  if (f.solidSpecificHeat > 0) e.solid = m.density * f.solidSpecificHeat;
  if (f.solidConductivity > 0) e.solidConductivity = f.solidConductivity;
  const double range = f.liquidus - f.solidus;
  e.between = m.density * f.latentHeat / range + (e.solid + e.liquid) / 2;
  e.atSolidus = e.solid * f.solidus;
  e.atLiquidus = e.atSolidus + e.between * range;
  return e;
}

EnthalpyTable EnthalpyTable::make(const std::vector<Material>& materials) {
  EnthalpyTable table;
  for (std::size_t m = 0; m < materials.size(); ++m) table.of[m] = Enthalpy::make(materials[m]);
  return table;
}

}  // namespace treacle
