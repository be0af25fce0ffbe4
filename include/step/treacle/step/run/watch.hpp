#pragma once

#include "treacle/model/case/case.hpp"

#include <array>
#include <string>
#include <vector>

namespace treacle {

struct Diagnostics;

/// What is watched in a step, each as a number that a bound of WatchSettings is for.
struct Watched {
  double energy = 0;       // rise of the mechanical energy over what start and gravity have given; 0: not known
  double courant = 0;      // way of the fastest particle in spacings
  double insideWalls = 0;  // share of the fluid's particles
  double density = 0;      // mean excess, for ISPH the mean error inside if that is larger
};

/// Looks at a run whether it still means anything. What goes wrong shows in the sums of the diagnostics: nothing
/// else is computed for it.
class Watch {
 public:
  /// `start`: the state that the run begins with; `mass`: of the fluid [kg; per metre of depth in 2D], `particles`
  /// their number. `wallsMove`: whether any wall does, or fluid comes and goes; the work that walls do on the
  /// fluid is not known.
  Watch(const Case& c, const Diagnostics& start, double mass, double particles, bool wallsMove);

  /// A step of `dt` [s] that leads to the state `d`. Appends to `warnings` what is noticed for the first time, or
  /// has doubled since. Errors: RunError beyond a bound, with what would help.
  Watched look(double dt, const Diagnostics& d, std::vector<std::string>& warnings);

  /// Whether so much fluid is away from surfaces that its mean density means something.
  bool tellsDensity(const Diagnostics& d) const;

  /// There is more or less fluid now.
  void setParticles(double particles) { particles_ = particles; }

  /// The same for one particle that is found too fast before the step has led anywhere.
  void requireSlow(double dt, double speed) const;

 private:
  struct Bound;
  static const std::array<Bound, 4>& bounds();

  double energyRise(double dt, const Diagnostics& d);
  std::string describeEnergy(double value, double dt) const;
  std::string describeCourant(double value, double dt) const;
  std::string describeInsideWalls(double value, double dt) const;
  std::string describeDensity(double value, double dt) const;
  std::string remedy(double dt) const;
  std::string unstableMaterial(double dt) const;

  Case case_;
  bool wallsMove_;
  bool pressed_ = false;  // the density was off by being too large
  double particles_;
  double given_;                               // at the start, and what is allowed for [J]
  double potential_ = 0;                       // since the start [J]
  double lowestPotential_ = 0, lowestEnergy_;  // so far [J]
  std::array<double, 4> warned_{};             // value of the last warning, by bound
};

}  // namespace treacle
