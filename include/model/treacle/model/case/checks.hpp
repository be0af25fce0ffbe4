#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/width.hpp"

#include <string>
#include <vector>

namespace treacle {

/// Steps to the end of a run that can be counted, and frames or checkpoints, too.
inline constexpr double maxSteps = 1e15;

/// Whether a case can be run, as far as that can be said without its particles: each value by itself, as
/// keys::visit bounds it, and what values must be together. Errors: CaseError, for the first that cannot be used.
void requireValid(const Case& c);
/// The same for a width of the case, and for what decides on bulk constants alone.
void requireValid(const Width& width, const Case& c);
void requireValidMaterialsAndInflows(const Case& c);

/// Dimensionless numbers of one material at the case's time step and spacing.
struct StabilityNumbers {
  std::string material;
  double compression = 0;     // dt kappa / lambda, at most mostCompression() for a stable step; 0 for ISPH
  double shearDiffusion = 0;  // d_mu = mu dt / (rho l^2) [K23 Table 2]
  double bulkDiffusion = 0;   // d_lambda = lambda dt / (rho l^2); Table 2 prints a tenth of it
};

std::vector<StabilityNumbers> stabilityNumbers(const Case& c);

/// Up to which dt kappa / lambda a step of MPH-I is stable: 1 [K23 eq. (12)], or 0.5 where the density, which the
/// elastic pressure is made of, has more neighbours than the divergence, which the bulk viscosity resists
/// (docs/accurate.md).
double mostCompression(const Case& c);
/// What bulk_modulus may be at most: "bulk_viscosity / step" or "0.5 bulk_viscosity / step".
std::string mostBulkModulusText(const Case& c);

/// The longest step for which a case of MPH-I is known to be stable, by its elastic pressures and by light fluids
/// under heavy ones.
struct StableStep {
  double length;       // [s]; infinite: any
  std::string reason;  // what bounds it
};
StableStep longestStableStep(const Case& c);

/// Gives automatic steps the bounds that the case leaves open, where they are 0: the longest is that which is
/// known to be stable, at most the whole run, the shortest defaultLeastStep().
void setStepBounds(Case& c);
/// A 10,000th of the longest one [s].
double defaultLeastStep(const TimeSettings& t);

/// dt U / l, where U is the largest of the initial speeds, the wall speeds and the speed of a free fall over the
/// height of the fluid; at most time.courant where that limits the steps.
double courantNumber(const Case& c);

/// What a user should know although the case can be run: unstable compression, fluids that cannot carry what lies
/// on them, long steps, keys without effect, thin walls, radii that are short for their weights, times that are
/// not whole numbers of steps.
std::vector<std::string> caseWarnings(const Case& c);

}  // namespace treacle
