#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

// Warnings of time steps that do not fit what a case says. The source has the bounds of automatic steps, too
// (checks.hpp).

/// The forces of MPH-I are implicit but for gravity; ISPH moves on what it has at the start of a step. How fast a
/// viscous fluid falls nobody knows before, so with MPH-I the speeds that the case gives count alone.
void warnCourant(const Case& c, std::vector<std::string>& warnings);

/// Steps that are longer than a twentieth of an oscillation miss much of it.
void warnOscillations(const Case& c, std::vector<std::string>& warnings);

/// Equal steps that do not meet the times of frames or the end.
void warnTimes(const Case& c, std::vector<std::string>& warnings);

/// Implicit viscous steps of ISPH, longer than l^2/nu. In a step pressures change velocities after viscosity has,
/// so fluid slips along walls by dt |grad p| / rho; and near free surfaces a part of the viscous stress is that of
/// the last step. Measured for the dam break of docs/validation.md, 20 particles wide: the front is 3 to 9 % too
/// far with 0.6 l^2/nu, 10 to 13 % with 2.5, 20 to 24 % with 10 (docs/notes/isph.md).
void warnViscousSteps(const Case& c, std::vector<std::string>& warnings);

}  // namespace treacle
