#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/state/bulk_memory.hpp"

namespace treacle {

/// Bulk over shear viscosity of a fluid that hardly changes its volume [K23 Table 1].
inline constexpr double recommendedBulkRatio = 1000;

/// Gives materials of MPH-I the bulk viscosities and moduli that the case leaves open (docs/choosing.md). The
/// largest pressures that the case lets expect compress a fluid by 0.1 %, those that drive it through a nozzle by
/// 1 %. Its bulk viscosity is recommendedBulkRatio times its viscosity, and so large that the step is half as long
/// as it may be. Materials that no fluid is made of have the largest constants of the fluids. Errors: InputError
/// for a nozzle in which no particle has room.
void setBulkConstants(Case& c);

/// How dense the fluid is inside.
struct FluidDensity {
  double excess;       // mean density over that at rest, less 1
  double compression;  // the part of it that the pressure p makes up: the mean of p / kappa
};

/// After a step of dt [s], of a run or its first one: raises constants that the case leaves open where pressures
/// make the fluid too dense. What makes it too dense otherwise, such as particles that pass each other in a thin
/// layer, a larger kappa does not cure. At first kappa grows, by up to 4 and as far as setBulkConstants() lets it
/// for the step, then both double. The next time comes when kappa has had the time to act, 2 lambda/kappa, and has
/// helped, or when the excess has grown by a fifth. A vessel that holds too much fluid from the start stays full:
/// its excess has to grow as well. Returns whether they are others now.
bool adaptBulkConstants(const Case& c, const FluidDensity& is, double dt, bool isFirst, BulkMemory& memory);

}  // namespace treacle
