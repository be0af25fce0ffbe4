#include "treacle/mph/viscosity_classes.hpp"

#include <algorithm>

namespace treacle {
namespace {

/// For the constants of the preconditioner that are numbers per material: its degree was found to suit the fluid
/// where it is thin, not where it is thick.
double flowingViscosity(const Rheology& r) { return std::min(r.viscosity(0.1), r.viscosity(10)); }

struct Range {
  double least, most;  // [Pa s]
};

/// Of shear rates from rest to a million per second, beyond which nothing flows that is computed here.
Range viscosities(const Rheology& r) {
  Range range{r.viscosity(0), r.viscosity(0)};
  for (double rate = 1e-6; rate < 2e6; rate *= 10) {
    range.least = std::min(range.least, r.viscosity(rate));
    range.most = std::max(range.most, r.viscosity(rate));
  }
  return range;
}

}  // namespace

ViscosityClasses ViscosityClasses::make(const Case& c) {
  ViscosityClasses classes;
  int shared = 0;  // by how many materials the other classes are
  for (const Material& m : c.materials) {
    classes.material[classes.count] = static_cast<std::uint8_t>(classes.count);
    classes.viscosity[classes.count++] = m.rheology ? flowingViscosity(*m.rheology) : m.dynamicViscosity;
    shared += m.rheology.has_value();
  }
  const int each = shared > 0 ? (most - classes.count) / shared : 0;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    if (!c.materials[m].rheology) continue;
    const Range range = viscosities(*c.materials[m].rheology);
    const double width = std::max(std::log(range.most / range.least) / each, 0.1);
    classes.steps_[m] = {classes.count, each, range.least, 1 / width};
    for (int k = 0; k < each; ++k) {
      classes.material[classes.count] = static_cast<std::uint8_t>(m);
      classes.viscosity[classes.count++] = range.least * std::exp((k + 0.5) * width);
    }
  }
  return classes;
}

}  // namespace treacle
