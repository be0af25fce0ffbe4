#pragma once

#include "treacle/model/case/case.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace treacle {

/// What a case says beforehand about the size and speed of its flow (docs/choosing.md).
struct FlowScales {
  double length = 0;        // L: shortest side of a fluid body or nozzle (fluidThickness) [m]
  double acceleration = 0;  // largest of gravity and centrifugal forces [m/s2]
  double potential = 0;     // work that they do per mass across the fluid: g H, in a frame that turns more [m2/s2]
  double fall = 0;          // speed that they give [m/s]
  double given = 0;         // largest of the speeds of fluid, walls, nozzles and openings that it gives [m/s]
  double pressure = 0;      // largest one of openings, and of given forces on bodies over their sections [Pa]
  double seep = 0;          // speed that the pressure gives against the viscosity, times the latter [Pa m]
  double shear = 0;         // pressure that fluid builds up in narrow ways, over its viscosity [1/s]
  double nozzleShear = 0;   // largest speed over width of nozzles [1/s]

  /// What drives a fluid of viscosity mu [Pa s] through one width of a nozzle [Pa]: for a tube 32 mu U / width.
  double nozzlePressure(double mu) const { return 32 * mu * nozzleShear; }
  /// A pressure that a fluid of density rho [kg/m3] and viscosity mu [Pa s] has to bear [Pa]: of its weight, of
  /// openings and forces, or in a nozzle or another narrow way.
  double pressureOf(double rho, double mu) const {
    return std::max({rho * potential, pressure, mu * shear, nozzlePressure(mu)});
  }
};

/// The largest speed of fluid that comes out of a nozzle in the run [m/s].
double inflowSpeed(const Case& c);

/// 0 where the case does not say. Errors: InputError for a nozzle in which no particle has room.
FlowScales flowScales(const Case& c);

/// Numbers of one fluid of a case. Those of something that it does not have are 0.
struct FluidNumbers {
  std::string material;
  double speed = 0;        // U: given, or what weight and pressures give, which viscosity holds back [m/s]
  double reynolds = 0;     // rho U L / mu
  double viscousTime = 0;  // rho L^2 / mu, in which a flow comes to rest or up to speed [s]
  double ratio = 0;        // lambda / mu
  double compression = 0;  // FlowScales::pressureOf / kappa
  double capillaryStep =
      0;            // up to which surface tension lets a step be: max(2 mu l/gamma, sqrt(rho l^3/gamma)) [s]
  double bond = 0;  // rho g L^2 / gamma
};

/// Of the materials that some fluid body or inflow is made of. `flow`: that of the case.
std::vector<FluidNumbers> fluidNumbers(const Case& c, const FlowScales& flow);
inline std::vector<FluidNumbers> fluidNumbers(const Case& c) { return fluidNumbers(c, flowScales(c)); }

// What follows stands in carried_fluids.cpp.

/// The additional viscosity that a material has under the pressure p [Pa] in steps of the case's length [Pa s]
/// (StiffnessLimits); 0 in the published scheme.
double additionalViscosity(const Case& c, const Material& m, double p);

/// The pressure that each fluid body of a material bears at least by the weight of heavier fluids [Pa], and the
/// largest one that its bodies have by their own weight and that of the fluids on them. Bodies whose files are not
/// there count as if they had no weight.
double pressureOfHeavier(const Case& c, const Material& m);
double pressureOfWeight(const Case& c, const Material& m);

}  // namespace treacle
