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

/// L sqrt(rho l^d) [m kg^0.5; per metre of depth in 2D], with the thickness L of the thinnest fluid, the density
/// rho of the heaviest one and the spacing l. For a particle of the kinetic energy E, sqrt(2 E) over this is its
/// speed over L, a rate at which fluid turns [1/s]. 0 without fluid, and where no material's constants follow the
/// density.
double turningScale(const Case& c);

/// How dense the fluid is inside.
struct FluidDensity {
  double excess;       // mean density over that at rest, less 1
  double compression;  // the part of it that the pressure p makes up: the mean of p / kappa
  double turning;      // turningScale() of the mean kinetic energy [1/s]
};

/// After a step of dt [s], of a run or its first one: raises constants that the case leaves open where the fluid
/// is too dense, in two ways. Returns whether they are others now.
///
/// Fluid that folds gets denser at some 0.04 of the rate at which it turns (docs/notes/volume.md). While it is too
/// dense kappa / lambda grows up to 16 times that rate. It falls when the fluid turns more slowly, and by half
/// each time that the excess is gone: pools at rest bear less without particles that move.
///
/// Where pressures make up half of the excess kappa grows by up to 4, as far as setBulkConstants() lets it for the
/// step, then both double. What makes it too dense otherwise, such as particles that pass each other in a thin
/// layer, this does not cure. The next time comes when kappa has had the time to act, 2 lambda/kappa, and has
/// helped, or when the excess has grown by a fifth. A vessel that holds too much fluid from the start stays full:
/// its excess has to grow as well.
bool adaptBulkConstants(const Case& c, const FluidDensity& is, double dt, bool isFirst, BulkMemory& memory);

}  // namespace treacle
