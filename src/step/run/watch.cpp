#include "treacle/step/run/watch.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/step/run/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace treacle {
namespace {

std::string exceeded(const std::string& text, const char* key, double most) {
  return fmt::format("{} (watch.{} = {:g} is exceeded)", text, key, most);
}

/// What surface tension can give to so much fluid, up to the surface of a cube or square of it [J].
double surfaceEnergy(const Case& c, double particles) {
  double tension = 0;
  for (const Material& m : c.materials) tension = std::max(tension, m.surfaceTension);
  const double d = c.dimensions;
  return tension * 2 * d * std::pow(c.spacing * std::pow(particles, 1 / d), d - 1);
}

}  // namespace

/// One number that is watched, what it may come to, from which share of that on it gives warnings, and what it
/// means.
struct Watch::Bound {
  const char* key;
  double Watched::*value;
  double WatchSettings::*most;
  double firstWarning, firstWarningOfIsph;
  std::string (Watch::*describe)(double value, double dt) const;
};

const std::array<Watch::Bound, 4>& Watch::bounds() {
  static constexpr std::array<Bound, 4> all = {{
      {"courant", &Watched::courant, &WatchSettings::courant, 0.25, 0.1, &Watch::describeCourant},
      {"energy", &Watched::energy, &WatchSettings::energy, 0.1, 0.2, &Watch::describeEnergy},
      {"inside_walls", &Watched::insideWalls, &WatchSettings::insideWalls, 0.1, 0.1, &Watch::describeInsideWalls},
      {"density", &Watched::density, &WatchSettings::density, 0.2, 0.2, &Watch::describeDensity},
  }};
  return all;
}

Watch::Watch(const Case& c, const Diagnostics& start, double mass, double particles, bool wallsMove)
    : case_(c), wallsMove_(wallsMove), particles_(particles), lowestEnergy_(start.kineticEnergy) {
  // Particles that find their places move by parts of a spacing, and slowly; where close ones repel each other, by
  // up to half the way of a pair in a step.
  const double speed = std::max(0.01 * c.spacing, 0.5 * c.repulsionRadius()) / c.time.step;
  const double settling = mass * (norm(c.gravity) * c.spacing + 0.5 * speed * speed);
  given_ = start.kineticEnergy + start.elasticEnergy + settling + surfaceEnergy(c, particles);
}

Watched Watch::look(double dt, const Diagnostics& d, std::vector<std::string>& warnings) {
  Watched w;
  w.energy = wallsMove_ || case_.hasVolumeFactors() ? 0 : energyRise(dt, d);
  w.courant = d.maxSpeed * dt / case_.spacing;
  w.insideWalls = particles_ > 0 ? d.insideWalls / particles_ : 0;
  // With MPH-I a few particles inside tell nothing: thin sheets and threads have hardly any.
  const bool tells = case_.method.kind == MethodKind::Isph || tellsDensity(d);
  w.density = std::max(d.excessDensity, tells ? d.meanDensityError : 0.0);
  pressed_ = d.excessDensity > 0.5 * w.density;
  for (std::size_t k = 0; k < bounds().size(); ++k) {
    const Bound& bound = bounds()[k];
    const double value = w.*bound.value, most = case_.watch.*bound.most;
    const bool isph = case_.method.kind == MethodKind::Isph;
    const double first = (isph ? bound.firstWarningOfIsph : bound.firstWarning) * most;
    if (most == 0 || (value <= most && value <= std::max(first, 2 * warned_[k]))) continue;
    const std::string text = (this->*bound.describe)(value, dt);
    if (value > most) throw RunError(exceeded(text, bound.key, most));
    warnings.push_back(fmt::format("{} (the run ends above watch.{} = {:g})", text, bound.key, most));
    warned_[k] = value;
  }
  return w;
}

bool Watch::tellsDensity(const Diagnostics& d) const { return d.interiorParticles > 0.25 * particles_; }

void Watch::requireSlow(double dt, double speed) const {
  const double value = speed * dt / case_.spacing, most = case_.watch.courant;
  if (most > 0 && value > most) throw RunError(exceeded(describeCourant(value, dt), "courant", most));
}

/// Walls at rest give the fluid no energy, unless it expands, and gravity gives what it has fallen: the sum of
/// both energies can only fall, but for what is elastic. Measured against the lowest sum so far, so that what
/// friction has taken does not hide a rise. The potential is summed up from the power of gravity, since particles
/// that cross a periodic end change that of the diagnostics.
double Watch::energyRise(double dt, const Diagnostics& d) {
  potential_ -= dt * d.gravityPower;
  const double energy = d.kineticEnergy + potential_;
  lowestEnergy_ = std::min(lowestEnergy_, energy);
  lowestPotential_ = std::min(lowestPotential_, potential_);
  const double rise = energy - lowestEnergy_, given = given_ - lowestPotential_;
  return given > 0 ? rise / given : 0;
}

std::string Watch::describeEnergy(double value, double dt) const {
  return fmt::format(
      "kinetic and potential energy of the fluid have risen by {:.3g} times what its start and gravity have given "
      "it, although no wall moves: the step is unstable; {}",
      value, remedy(dt));
}

std::string Watch::describeCourant(double value, double dt) const {
  const bool isph = case_.method.kind == MethodKind::Isph;
  const double speed = value * case_.spacing / dt, wanted = isph ? 0.25 : 0.5;
  const std::string numbers = fmt::format(
      "the fastest particle goes at {:.3g} m/s, {:.3g} spacings in a step of {:.3g} s", speed, value, dt);
  if (const std::string cause = unstableMaterial(dt); !cause.empty())
    return fmt::format("{}: the step is unstable; {}", numbers, cause);
  if (flowScales(case_).given > 0.5 * speed)
    return fmt::format("{}, which the case gives; take {} <= {:.2g} or time.courant = {:g}", numbers,
                       case_.time.stepKey(), wanted * case_.spacing / speed, wanted);
  if (value > 1000) return fmt::format("{}: the step is unstable; {}", numbers, remedy(dt));  // nobody means that
  return fmt::format(
      "{}; take {} <= {:.2g} or time.courant = {:g}. Speeds that the flow cannot have come from "
      "an unstable step: {}",
      numbers, case_.time.stepKey(), wanted * case_.spacing / speed, wanted, remedy(dt));
}

std::string Watch::describeInsideWalls(double value, double dt) const {
  return fmt::format(
      "{:.0f} of {:.0f} fluid particles are inside walls: the pressure does not hold them back; {}make walls as "
      "thick as particles act on each other, and {}",
      value * particles_, particles_,
      case_.method.kind == MethodKind::Isph ? "" : "raise bulk_viscosity and bulk_modulus where they are small, ",
      remedy(dt));
}

std::string Watch::describeDensity(double value, double dt) const {
  return fmt::format(
      "the density of the fluid is off by {:.3g} % in the mean: {}{}{}", 100 * value,
      pressed_ && wallsMove_
          ? "walls that move or fluid that comes in press it together. Where there is no room for it, "
            "stop them sooner or let it out; elsewhere "
          : "",
      case_.method.kind == MethodKind::Isph
          ? ""
          : "raise bulk_modulus, because errors of the density vanish over bulk_viscosity / bulk_modulus, "
            "bulk_viscosity where it is below 1000 dynamic_viscosity, dynamic_viscosity where a light fluid "
            "carries a heavy one, and ",
      remedy(dt));
}

std::string Watch::remedy(double dt) const {
  if (const std::string cause = unstableMaterial(dt); !cause.empty()) return cause;
  return fmt::format(
      "take {} <= {:.3g}{}", case_.time.stepKey(), dt / 2,
      case_.method.kind == MethodKind::Isph ? ", and leave the fluid a free surface where it has none" : "");
}

/// kappa dt / lambda above its bound is the instability that MPH-I is known for.
std::string Watch::unstableMaterial(double dt) const {
  if (case_.method.kind != MethodKind::MphI) return {};
  const double most = mostCompression(case_);
  for (const Material& m : case_.materials) {
    if (m.bulkModulus * dt <= most * m.bulkViscosity * (1 + 1e-6)) continue;
    if (m.bulkViscosity == 0)
      return fmt::format("give '{}' a bulk_viscosity of at least bulk_modulus times the step = {:.3g}", m.name,
                         m.bulkModulus * dt);
    return fmt::format("take bulk_modulus <= {} = {:.3g} for '{}', or {} <= {:.3g}", mostBulkModulusText(case_),
                       most * m.bulkViscosity / dt, m.name, case_.time.stepKey(),
                       most * m.bulkViscosity / m.bulkModulus);
  }
  return {};
}

}  // namespace treacle
