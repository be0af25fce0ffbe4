#pragma once

#include "treacle/model/materials/freezing.hpp"
#include "treacle/model/materials/material.hpp"

#include <vector>

namespace treacle {

/// The enthalpy of a material per volume [J/m3], counted from 0 K, by its temperature [K]. It rises everywhere, in
/// three straight pieces: by the heat capacity of the solid up to the solidus, by the latent heat and the mean of
/// both capacities up to the liquidus, by the capacity of the liquid beyond. A material that does not freeze has
/// the last piece alone.
struct Enthalpy {
  FrozenShare frozen{};
  double solid = 0, between = 0, liquid = 0;             // slopes [J/(m3 K)]
  double atSolidus = 0, atLiquidus = 0;                  // [J/m3]
  double solidConductivity = 0, liquidConductivity = 0;  // [W/(m K)]

  static Enthalpy make(const Material& m);

  TREACLE_HD double at(double T) const {
    if (T >= frozen.liquidus) return atLiquidus + liquid * (T - frozen.liquidus);
    return T > frozen.solidus ? atSolidus + between * (T - frozen.solidus) : solid * T;
  }
  /// The temperature at which the enthalpy is h.
  TREACLE_HD double temperature(double h) const {
    if (h >= atLiquidus) return frozen.liquidus + (h - atLiquidus) / liquid;
    return h > atSolidus ? frozen.solidus + (h - atSolidus) / between : h / solid;
  }
  /// dh/dT.
  TREACLE_HD double slope(double T) const {
    return T >= frozen.liquidus ? liquid : T > frozen.solidus ? between : solid;
  }
  TREACLE_HD double leastSlope() const {
    const double least = solid < liquid ? solid : liquid;
    return between < least ? between : least;
  }
  /// Linear in the frozen share.
  TREACLE_HD double conductivity(double T) const {
    return liquidConductivity + frozen.share(T) * (solidConductivity - liquidConductivity);
  }
  /// The integral of the conductivity over the temperature, from the solidus on [W/m].
  TREACLE_HD double conducted(double T) const {
    const double above = T - frozen.solidus, range = frozen.liquidus - frozen.solidus;
    if (above <= 0) return solidConductivity * above;
    if (above >= range)
      return (solidConductivity + liquidConductivity) / 2 * range + liquidConductivity * (above - range);
    return (solidConductivity + (liquidConductivity - solidConductivity) * above / (2 * range)) * above;
  }
};

/// The enthalpies of all materials of a case.
struct EnthalpyTable {
  Enthalpy of[maxMaterials];

  static EnthalpyTable make(const std::vector<Material>& materials);
};

}  // namespace treacle
