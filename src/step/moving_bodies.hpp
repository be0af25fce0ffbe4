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
  if (someWallOscillates(c) || someWallRotates(c) || c.hasInflow() || c.hasRigid()) return true;
  for (std::uint32_t i = particles.wallBegin(); i < particles.count; ++i)
    if (norm2(particles.velocity[i]) > 0) return true;
  return false;
}

/// Sets motions and velocities of the walls for state.timeStep from state.time on: those of the bodies, with the
/// speeds that nozzles have, and that rigid bodies are tried with.
template <int D, class Backend>
void setWallMotions(FlowState<D, Backend>& state) {
  std::vector<WallMotion<D>> motion;
  const Case& c = state.theCase;
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    if (c.bodies[b].kind == BodyKind::Rigid) {
      motion.push_back(rigidMotion<D>(state.rigid.bodies[b], state.timeStep));
      continue;
    }
    motion.push_back(wallMotion<D>(c.domain, c.bodies[b], state.time, state.timeStep));
    if (const auto& nozzle = state.nozzles[b])
      motion.back().velocity =
          motion.back().velocity + nozzle->speed(state.time, state.timeStep) * nozzle->direction();
  }
  fromHost(state.context, std::span<const WallMotion<D>>(motion), state.wallMotion);
  Particles<D, Backend>& p = state.particles;
  const std::uint32_t n = p.wallBegin();
  setWallVelocities<D>(state.context, {state.wallMotion, p.body.span().subspan(n), p.position.span().subspan(n)},
                       p.velocity.span().subspan(n));
}

/// What the walls of a state that it refers to move with: those that oscillate or rotate by the motions of their
/// bodies, inflows with the speeds of their fluid, the others by the velocities that they have.
template <int D, class Backend>
class MovingBodies {
 public:
  explicit MovingBodies(FlowState<D, Backend>& state)
      : state_(state),
        rotate_(someWallRotates(state.theCase) || state.theCase.hasRigid()),
        velocitiesChange_(rotate_ || someWallOscillates(state.theCase) || state.theCase.hasInflow()) {}

  /// Motions and velocities for state.timeStep from state.time on.
  void prepare() {
    if (!velocitiesChange_) return;
    setWallMotions(state_);
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
