#pragma once

#include "treacle/model/materials/elastic_mode.hpp"
#include "treacle/model/materials/freezing.hpp"
#include "treacle/model/materials/material_state.hpp"
#include "treacle/model/materials/rheology.hpp"
#include "treacle/model/materials/viscosity_shift.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// That of a wall with the free surfaces of one fluid.
struct ContactAngle {
  std::string name;   // of the fluid's material
  double angle = 90;  // measured in the fluid [deg]

  bool operator==(const ContactAngle&) const = default;
};

struct Material {
  std::string name;
  double density = 0;           // rho [kg/m3]
  double dynamicViscosity = 0;  // mu, without a rheology [Pa s]
  double bulkViscosity = 0;     // lambda [Pa s]
  double bulkModulus = 0;       // kappa [Pa]
  double slipLength = 0;        // how far behind a wall its velocity, extrapolated, is the wall's [m]; 0: no slip
  double surfaceTension = 0;    // gamma of its free surface [N/m]; MPH-I only
  double contactAngle = 90;     // of a wall, with free surfaces of all other fluids than these [deg]
  std::vector<ContactAngle> contactAngles{};
  std::optional<Rheology> rheology{};   // of a fluid that is not Newtonian; MPH-I only
  std::vector<ElasticMode> elastic{};   // of a fluid that is elastic, too; MPH-I only
  std::vector<MaterialState> states{};  // MPH-I only
  // Expressions in them, the temperature T, shear_rate and t, by which the viscosity, a yield stress and the
  // volume are multiplied; empty: 1. MPH-I only.
  std::string viscosityFactor{}, yieldFactor{}, volumeFactor{};
  std::optional<Gelling> gelling{};
  // In cases with heat.
  double specificHeat = 0;                         // c_p [J/(kg K)]
  double conductivity = 0;                         // k [W/(m K)]
  double emissivity = 0;                           // of the free surface [-]
  std::optional<ViscosityShift> viscosityShift{};  // missing: the viscosity does not follow the temperature
  std::optional<Freezing> freezing{};              // missing: it never freezes
  double thermalExpansion = 0;                     // beta, in the weight alone [1/K]
  double expansionTemperature = 0;                 // at which the density is rho; 0: the ambient one [K]
  // Whether the case leaves lambda and kappa to setBulkConstants().
  bool autoBulkViscosity = false, autoBulkModulus = false;

  /// Whether both follow the density in the run (BulkMemory).
  bool hasOpenBulk() const { return autoBulkViscosity && autoBulkModulus; }

  /// mu at a shear rate [1/s], where a_T is `shift` and the yield stress is multiplied by `yield` [Pa s]. Formulas
  /// are not in it.
  double viscosity(double rate, double shift, double yield = 1) const {
    return rheology ? rheology->viscosity(rate, shift, yield) : shift * dynamicViscosity;
  }
  /// Of a wall of this material with a fluid [deg].
  double contactAngleWith(std::string_view fluid) const {
    for (const ContactAngle& a : contactAngles)
      if (a.name == fluid) return a.angle;
    return contactAngle;
  }
  /// Whether its viscosity is not one number. Laws of states may need shear rates, which come with it.
  bool hasOwnViscosities() const {
    return rheology.has_value() || viscosityShift.has_value() || freezing.has_value() || hasFormulas() ||
           !elastic.empty();
  }
  /// Sum of the viscosities of its elastic modes [Pa s].
  double elasticViscosity() const {
    double sum = 0;
    for (const ElasticMode& mode : elastic) sum += mode.viscosity;
    return sum;
  }
  bool hasFormulas() const {
    return !states.empty() || !viscosityFactor.empty() || !yieldFactor.empty() || !volumeFactor.empty() ||
           gelling.has_value();
  }

  bool operator==(const Material&) const = default;
};

/// Largest number of materials of one case: pair sums look their constants up in small tables.
inline constexpr std::size_t maxMaterials = 16;

}  // namespace treacle
