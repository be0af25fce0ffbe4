#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

/// What a material does between the temperatures at which it is all solid and all liquid. The rest of the material
/// is its liquid.
struct Freezing {
  double solidus = 0;            // all solid up to this temperature [K]
  double liquidus = 0;           // all liquid from this temperature on [K]
  double latentHeat = 0;         // set free between them [J/kg]
  double solidConductivity = 0;  // of what is frozen; 0: that of the liquid [W/(m K)]
  double solidSpecificHeat = 0;  // likewise [J/(kg K)]
  double solidFactor = 1e3;      // by which the viscosity of what is all solid is multiplied [-]

  bool operator==(const Freezing&) const = default;
};

/// The same as constants, for device code. Without them nothing is ever frozen.
struct FrozenShare {
  double solidus = 0, liquidus = 0;  // [K]
  double logFactor = 0;              // of the viscosity

  static FrozenShare make(const Freezing& f) { return {f.solidus, f.liquidus, std::log(f.solidFactor)}; }

  /// Of T [K]: linear in it, 1 at the solidus and 0 at the liquidus.
  TREACLE_HD double share(double T) const {
    if (T >= liquidus) return 0;
    return T > solidus ? (liquidus - T) / (liquidus - solidus) : 1;
  }
  /// By what the viscosity is multiplied: its logarithm is linear in the share.
  TREACLE_HD double viscosityFactor(double T) const { return T >= liquidus ? 1 : std::exp(logFactor * share(T)); }
};

}  // namespace treacle
