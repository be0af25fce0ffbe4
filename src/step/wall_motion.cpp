#include "treacle/step/wall_motion.hpp"

#include "treacle/core/parallel.hpp"

#include <cmath>
#include <numbers>

namespace treacle {

Vec<3> wallVelocity(const Body& body, double t, double dt) {
  const Oscillation& o = body.oscillation;
  if (o.period == 0) return body.velocity;
  const double omega = 2 * std::numbers::pi / o.period;
  const double way = std::sin(omega * (t + dt) + o.phase) - std::sin(omega * t + o.phase);
  return body.velocity + (way / dt) * o.amplitude;
}

Vec<3> wallAcceleration(const Body& body, double t) {
  const Oscillation& o = body.oscillation;
  if (o.period == 0) return {};
  const double omega = 2 * std::numbers::pi / o.period;
  return (-omega * omega * std::sin(omega * t + o.phase)) * o.amplitude;
}

template <int D>
void setWallVelocities(Context<Cpu>&, std::span<const std::uint8_t> body, std::span<const Vec<D>> bodyVelocity,
                       std::span<Vec<D>> velocity) {
  parallelFor(velocity.size(), parallelGrain, [&](std::size_t k) { velocity[k] = bodyVelocity[body[k]]; });
}

template void setWallVelocities<2>(Context<Cpu>&, std::span<const std::uint8_t>, std::span<const Vec<2>>,
                                   std::span<Vec<2>>);
template void setWallVelocities<3>(Context<Cpu>&, std::span<const std::uint8_t>, std::span<const Vec<3>>,
                                   std::span<Vec<3>>);

}  // namespace treacle
