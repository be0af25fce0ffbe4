#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle {

/// Bulk over shear viscosity of a fluid that hardly changes its volume [K23 Table 1].
inline constexpr double recommendedBulkRatio = 1000;

/// Gives materials of MPH-I the bulk viscosities and moduli that the case leaves open (docs/choosing.md). The
/// largest pressures that the case lets expect compress a fluid by 0.1 %, those that drive it through a nozzle by
/// 1 %. Its bulk viscosity is recommendedBulkRatio times its viscosity, and so large that the step is half as long
/// as it may be. Materials that no fluid is made of have the largest constants of the fluids. Errors: InputError
/// for a nozzle in which no particle has room.
void setBulkConstants(Case& c);

}  // namespace treacle
