#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

// Checks of fluids that lie on other fluids and on themselves.

/// Relative error that checks of a case allow for rounding.
inline constexpr double rounding = 1e-6;

inline const Material& materialOf(const Case& c, const Body& body) {
  return c.materials[static_cast<std::size_t>(body.material)];
}

/// What the fluid bodies that lie on a fluid body weigh, as a pressure [Pa]: those above it along gravity, which
/// is not zero, that overlap with it across. `heavier`: only those of a larger density.
double weightOn(const Case& c, const Body& below, bool heavier);

/// The longest step of a fluid that carries the pressure p [Pa] of heavier ones [s]; infinite in the accurate
/// scheme, if the fluid has a viscosity.
double longestCarryingStep(const Case& c, const Material& m, double p);

/// The pressure at the foot of a fluid body by its own weight and that of the fluid on it [Pa].
double pressureIn(const Case& c, const Body& body);

/// Warns of fluids that are too light and too thin for the heavier fluid on them, by the way in spacings that a
/// particle goes in a step if the pressure acts on one side of it alone. Light and thin fluids cannot keep their
/// particles in order under a heavy one: those give way, the density rises, and the heavy fluid sinks in. Measured
/// for a fluid of 1 to 1000 kg/m3 and 1e-4 to 1 Pa s under one of 1000 kg/m3 and 10 Pa s: it carries with 0.5;
/// with 3 it does not.
void warnLightFluids(const Case& c, std::vector<std::string>& warnings);

/// Warns of fluids that their own weight and that of the fluids on them compress: the bulk modulus lets a fluid be
/// compressed by p / kappa in the end, the bulk viscosity by p / lambda in a second.
void warnSoftFluids(const Case& c, std::vector<std::string>& warnings);

}  // namespace treacle
