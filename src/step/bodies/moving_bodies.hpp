#pragma once

#include "rigid_mass.hpp"
#include "run/flow_state.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/step/walls/wall_motion.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

/// Whether some wall moves, at the time of these particles or at any other.
template <int D>
bool someWallMoves(const Case& c, const Particles<D>& particles) {
  if (someWallIsDriven(c) || someWallRotates(c) || c.hasInflow() || c.hasRigid()) return true;
  for (std::uint32_t i = particles.wallBegin(); i < particles.count; ++i)
    if (norm2(particles.velocity[i]) > 0) return true;
  return false;
}

/// The motion of a rigid body in a step of dt [s] that changes its velocities from those that it had `before`.
template <int D>
WallMotion<D> rigidMotion(const RigidBody& before, const RigidBody& body, double dt) {
  WallMotion<D> m = rigidMotion<D>(body, dt);
  m.acceleration = resized<D>((1 / dt) * (body.velocity - before.velocity));
  m.spinChange = (1 / dt) * (body.spin - before.spin);
  return m;
}

/// The motion of body b of the case, which is not rigid, over dt from time t on; nozzles have their present
/// speeds.
template <int D, class Backend>
WallMotion<D> drivenMotion(const FlowState<D, Backend>& state, std::size_t b, double t, double dt) {
  const Case& c = state.theCase;
  const auto& nozzle = state.nozzles[b];
  return nozzle ? nozzle->motion(c.domain, t, dt) : wallMotion<D>(c.domain, c.bodies[b], t, dt);
}

/// What walls go by from the start of the step at hand to dt later, per body of the case; rigid bodies with these
/// velocities.
template <int D, class Backend>
std::vector<WallMotion<D>> waysOfBodies(const FlowState<D, Backend>& state, const std::vector<RigidBody>& rigid,
                                        double dt) {
  std::vector<WallMotion<D>> motion;
  for (std::size_t b = 0; b < state.theCase.bodies.size(); ++b) {
    if (state.theCase.bodies[b].kind == BodyKind::Rigid) {
      RigidBody body = rigid[b];
      body.center = state.particles.rigid.bodies[b].center;  // at the start, whatever that of the velocities is
      motion.push_back(rigidMotion<D>(body, dt));
    } else {
      motion.push_back(drivenMotion<D>(state, b, state.time, dt));
    }
  }
  return motion;
}

/// What the fluid meets in the step at hand where walls are then: driven ones with the mean velocities of the
/// step, rigid ones with those that they are tried with.
template <int D, class Backend>
std::vector<WallMotion<D>> bodyMotions(const FlowState<D, Backend>& state) {
  std::vector<WallMotion<D>> motion;
  const double dt = state.timeStep, early = state.theCase.middleShare() * dt;
  for (std::size_t b = 0; b < state.theCase.bodies.size(); ++b) {
    if (state.theCase.bodies[b].kind == BodyKind::Rigid) {
      motion.push_back(rigidMotion<D>(state.particles.rigid.bodies[b], state.rigid.bodies[b], state.velocityStep));
      continue;
    }
    WallMotion<D> m = drivenMotion<D>(state, b, state.time + early, dt - early);
    if (early > 0) {
      const WallMotion<D> whole = drivenMotion<D>(state, b, state.time, dt);
      m.velocity = whole.velocity;
      if (const auto& nozzle = state.nozzles[b]) {  // in the direction that it has now, not at the end
        const double t = state.time;
        m.velocity += nozzle->speed(t, dt) * (nozzle->direction(t + early) - nozzle->direction(t + dt));
      }
      m.spin = whole.spin;
      m.along = 1, m.inwards = 0;
    }
    motion.push_back(m);
  }
  return motion;
}

/// Adds to velocities of the layers of nozzles, in the step of dt from the start of that at hand on, what their
/// columns have beside the mean. `position`: of wall particles at time t; `end`: whose directions they have [s].
template <int D, class Backend>
void addProfiles(FlowState<D, Backend>& state, double t, double end, double dt, std::span<const Vec<D>> position,
                 std::span<Vec<D>> velocity) {
  const Particles<D, Backend>& p = state.particles;
  for (std::size_t b = 0; b < state.nozzles.size(); ++b) {
    const auto& nozzle = state.nozzles[b];
    if (!nozzle || nozzle->isPlug()) continue;
    const Vec<D> mean = nozzle->speed(state.time, dt) * nozzle->direction(end);
    addToColumns<D>(state.context, state.columnsOf(b, t, nozzle->excess(), mean),
                    p.body.span().subspan(p.wallBegin()), position, velocity);
  }
}

/// Sets motions and velocities of the walls to these.
template <int D, class Backend>
void setWallMotions(FlowState<D, Backend>& state) {
  const std::vector<WallMotion<D>> motion = bodyMotions(state);
  fromHost(state.context, std::span<const WallMotion<D>>(motion), state.wallMotion);
  Particles<D, Backend>& p = state.particles;
  const std::uint32_t n = p.wallBegin();
  setWallVelocities<D>(state.context, {state.wallMotion, p.body.span().subspan(n), p.position.span().subspan(n)},
                       p.velocity.span().subspan(n));
  const double t = state.time, dt = state.timeStep, early = state.theCase.middleShare() * dt;
  addProfiles<D>(state, t + early, t + (early > 0 ? early : dt), dt, p.position.span().subspan(n),
                 p.velocity.span().subspan(n));
}

/// What the walls of a state that it refers to move with: those that oscillate or rotate by the motions of their
/// bodies, inflows with the speeds of their fluid, the others by the velocities that they have.
template <int D, class Backend>
class MovingBodies {
 public:
  explicit MovingBodies(FlowState<D, Backend>& state)
      : state_(state),
        velocitiesChange_(someWallRotates(state.theCase) || state.theCase.hasRigid() ||
                          someWallIsDriven(state.theCase) || state.theCase.hasInflow()) {}

  /// What the state does not know of its rigid bodies, and how far bodies reach. `particles`: the state's, as each
  /// process comes with them. Collective.
  void begin(Particles<D>& particles) {
    const Case& c = state_.theCase;
    if (!c.hasRigid())
      particles.rigid = {};
    else
      begin(particles.rigid.bodies, rigidBodies<D>(c, state_.context, particles));
    state_.rigid = particles.rigid;
    reach_.resize(c.bodies.size());
    for (std::uint32_t i = particles.wallBegin(); i < particles.count; ++i)
      if (const std::size_t b = particles.body[i]; b < reach_.size())
        reach_[b] = std::max(reach_[b], norm(resized<3>(particles.position[i]) - centerOf(b)));
    for (double& reach : reach_)
      reach = joinedOverProcesses(state_.context, reach, [](double a, double b) { return std::max(a, b); });
  }

  /// Motions and velocities for the step at hand where walls are in it. In cases with rigid bodies the method sets
  /// them once it knows what velocities to try (RigidSystem).
  void prepare() {
    if (velocitiesChange_ && !state_.theCase.hasRigid()) setWallMotions(state_);
  }

  /// What no part of a body exceeds in the step at hand whose speed the case does not give as a number [m/s].
  double freeSpeed() const {
    const Case& c = state_.theCase;
    double speed = 0;
    for (std::size_t b = 0; b < c.bodies.size(); ++b) {
      const Body& body = c.bodies[b];
      const bool rigid = body.kind == BodyKind::Rigid;
      if (!rigid && !isDriven(body.displacement) && !(body.rotation && body.rotation->angle)) continue;
      const WallMotion<D> m = rigid ? rigidMotion<D>(state_.rigid.bodies[b], state_.timeStep)
                                    : wallMotion<D>(c.domain, body, state_.time, state_.timeStep);
      speed = std::max(speed, norm(m.velocity) + norm(m.spin) * reach_[b]);
    }
    return speed;
  }

  /// What no part of a rigid body should exceed in the next step, which is at most twice as long as the last one
  /// [m/s].
  double expectedSpeed() const {
    const RigidMotion& motion = state_.particles.rigid;
    double speed = 0, change = 0;
    for (std::size_t b = 0; b < motion.bodies.size(); ++b)
      speed = std::max(speed, norm(motion.bodies[b].velocity) + norm(motion.bodies[b].spin) * reach_[b]);
    for (const double x : motion.change) change += x * x;
    return speed + 2 * std::sqrt(change);
  }

  /// The rigid bodies have gone on with the velocities of the step.
  void accept() {
    if (!state_.theCase.hasRigid()) return;
    std::vector<RigidBody> bodies = state_.particles.rigid.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (bodies[b].mass == 0) continue;
      bodies[b].velocity = state_.rigid.bodies[b].velocity;
      bodies[b].spin = state_.rigid.bodies[b].spin;
      bodies[b].advance(state_.timeStep);
    }
    state_.rigid.bodies = std::move(bodies);
    state_.particles.rigid = state_.rigid;
  }

  /// By what dt is multiplied to give the ways of the wall particles from the start of the step at hand to dt [s]
  /// later [m/s]. `from`: where they are at its start. `rigid`: rigid bodies with the velocities that they go by.
  std::span<const Vec<D>> ways(std::span<const Vec<D>> from, double dt, const std::vector<RigidBody>& rigid) {
    const Particles<D, Backend>& p = state_.particles;
    const std::uint32_t n = p.wallBegin();
    if (!velocitiesChange_) return p.velocity.span().subspan(n);
    const std::vector<WallMotion<D>> motion = waysOfBodies(state_, rigid, dt);
    fromHost(state_.context, std::span<const WallMotion<D>>(motion), way_);
    chord_.resize(state_.context, p.wallCount());
    setWallChords<D>(state_.context, {way_, p.body.span().subspan(n), from}, chord_);
    addProfiles<D>(state_, state_.time, state_.time + dt, dt, from, chord_.span());
    return chord_.span();
  }

  std::size_t bytes() const { return way_.bytes() + chord_.bytes(); }

 private:
  /// Those of which the state knows nothing begin as the case says.
  static void begin(std::vector<RigidBody>& bodies, const std::vector<RigidBody>& ofCase) {
    bodies.resize(ofCase.size());
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].mass == 0) bodies[b] = ofCase[b];
  }

  Vec<3> centerOf(std::size_t b) const {
    const Body& body = state_.theCase.bodies[b];
    return body.kind == BodyKind::Rigid ? state_.rigid.bodies[b].center : wallCenter(body, state_.time);
  }

  FlowState<D, Backend>& state_;
  std::vector<double> reach_;  // per body: from its centre to its farthest wall particle [m]
  bool velocitiesChange_;
  Buffer<WallMotion<D>, Backend> way_;  // waysOfBodies()
  Buffer<Vec<D>, Backend> chord_;       // per wall particle, where velocities change [m/s]
};

}  // namespace treacle
