#include "diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {

template <int D>
Diagnostics computeDiagnostics(const Case& c, const MaterialTable& materials, const Particles<D>& particles) {
  const Vec<D> gravity = resized<D>(c.gravity);
  const double g = norm(gravity);
  Vec<D> up{};
  up[D - 1] = 1;  // without gravity the last axis counts as height
  if (g > 0) up = gravity * (-1 / g);
  const double volume = std::pow(c.spacing, D);  // [K23 eq. (11)]

  Diagnostics d;
  d.frontX = d.top = -std::numeric_limits<double>::infinity();
  double maxSpeed2 = 0;
  for (std::uint32_t i = 0; i < particles.fluidCount; ++i) {
    const Vec<D>& x = particles.position[i];
    const double speed2 = norm2(particles.velocity[i]);
    const double mass = materials.density[particles.material[i]] * volume;
    d.kineticEnergy += 0.5 * mass * speed2;
    d.potentialEnergy -= mass * dot(gravity, x);
    d.frontX = std::max(d.frontX, x[0]);
    d.top = std::max(d.top, dot(up, x));
    maxSpeed2 = std::max(maxSpeed2, speed2);
  }
  d.maxSpeed = std::sqrt(maxSpeed2);
  return d;
}

template Diagnostics computeDiagnostics<2>(const Case&, const MaterialTable&, const Particles<2>&);
template Diagnostics computeDiagnostics<3>(const Case&, const MaterialTable&, const Particles<3>&);

}  // namespace treacle
