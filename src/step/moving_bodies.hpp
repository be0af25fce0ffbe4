#pragma once

#include "flow_state.hpp"
#include "treacle/model/wall_motion.hpp"
#include "treacle/step/wall_motion.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Whether some wall moves, at the time of these particles or at any other.
template <int D>
bool someWallMoves(const Case& c, const Particles<D>& particles) {
  if (someWallOscillates(c) || someWallRotates(c) || c.hasInflow()) return true;
  for (std::uint32_t i = particles.wallBegin(); i < particles.count; ++i)
    if (norm2(particles.velocity[i]) > 0) return true;
  return false;
}

/// What the walls of a state that it refers to move with: those that oscillate or rotate by the motions of their
/// bodies, inflows with the speeds of their fluid, the others by the velocities that they have.
template <int D, class Backend>
class MovingBodies {
 public:
  explicit MovingBodies(FlowState<D, Backend>& state)
      : state_(state),
        rotate_(someWallRotates(state.theCase)),
        velocitiesChange_(rotate_ || someWallOscillates(state.theCase) || state.theCase.hasInflow()) {}

  /// Motions and velocities for state.timeStep from state.time on.
  void prepare() {
    if (!velocitiesChange_) return;
    std::vector<WallMotion<D>> motion;
    for (const Body& body : state_.theCase.bodies)
      motion.push_back(wallMotion<D>(state_.theCase.domain, body, state_.time, state_.timeStep));
    for (std::size_t b = 0; b < motion.size(); ++b)
      if (const auto& nozzle = state_.nozzles[b])
        motion[b].velocity =
            motion[b].velocity + nozzle->speed(state_.time, state_.timeStep) * nozzle->direction();
    fromHost(state_.context, std::span<const WallMotion<D>>(motion), state_.wallMotion);
    setWallVelocities<D>(state_.context, walls(), velocities());
  }

  /// By what dt is multiplied to give the ways of the wall particles in the step [m/s].
  std::span<const Vec<D>> transportVelocities() {
    if (!rotate_) return velocities();
    chord_.resize(state_.context, state_.particles.wallCount());
    setWallChords<D>(state_.context, walls(), chord_);
    return chord_.span();
  }

  std::size_t bytes() const { return chord_.bytes(); }

 private:
  MovingWalls<D> walls() const {
    const Particles<D, Backend>& p = state_.particles;
    const std::uint32_t n = p.wallBegin();
    return {state_.wallMotion, p.body.span().subspan(n), p.position.span().subspan(n)};
  }
  std::span<Vec<D>> velocities() { return state_.particles.velocity.span().subspan(state_.particles.wallBegin()); }

  FlowState<D, Backend>& state_;
  bool rotate_, velocitiesChange_;
  Buffer<Vec<D>, Backend> chord_;  // per wall particle, where some rotate [m/s]
};

}  // namespace treacle
