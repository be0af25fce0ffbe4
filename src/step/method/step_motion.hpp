#pragma once

#include "bodies/moving_bodies.hpp"
#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/step/method/move_particles.hpp"
#include "treacle/step/run/watch.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

/// How the particles of a state get from the start of the step at hand to its middle, back, and to its end.
template <int D, class Backend>
class StepMotion {
 public:
  /// Both must outlive this.
  StepMotion(FlowState<D, Backend>& state, MovingBodies<D, Backend>& bodies) : state_(state), bodies_(bodies) {}

  /// All go to where they are dt [s] after the start: the fluid with the velocities that it has, walls by their
  /// own motion. Errors: RunError; the state is then as before.
  void goTo(const CellGrid<D>& grid, const Watch& watch, double dt) {
    Particles<D, Backend>& p = state_.particles;
    move(grid, watch, dt, p.velocity, p.rigid.bodies);
    p.start.resize(state_.context, p.count);
    copyValues(state_.context, std::span<const Vec<D>>(p.position), p.start.data());
    p.has.starts = true;
    takeMoved();
  }

  /// Back to where all were at the start.
  void goBack() {
    Particles<D, Backend>& p = state_.particles;
    if (!std::exchange(p.has.starts, false)) return;
    copyValues(state_.context, std::span<const Vec<D>>(p.start), p.position.data());
    p.start.resize(state_.context, 0);
  }

  /// x^{k+1} = x^k + dt u^{k+1} of [K23 eq. (15)] into the state's `position`; walls by their prescribed motion.
  /// `u`: of the fluid; `rigid`: rigid bodies with their velocities. Errors: RunError.
  void move(const CellGrid<D>& grid, const Watch& watch, double dt, std::span<const Vec<D>> u,
            const std::vector<RigidBody>& rigid) {
    const Particles<D, Backend>& p = state_.particles;
    const std::uint32_t n = p.wallBegin();
    state_.position.resize(state_.context, state_.wallsMove ? p.count : p.fluidCount);
    agreed(state_.context, [&] {
      moveRange(grid, watch, 0, p.fluidCount, dt, u);
      if (state_.wallsMove) moveRange(grid, watch, n, p.count, dt, bodies_.ways(starts().subspan(n), dt, rigid));
    });
  }

  /// Particles are where they were moved to, and the step is over.
  void accept() {
    takeMoved();
    Particles<D, Backend>& p = state_.particles;
    if (std::exchange(p.has.starts, false)) p.start.resize(state_.context, 0);
  }

 private:
  /// Places that particles have at the start.
  std::span<const Vec<D>> starts() const {
    const Particles<D, Backend>& p = state_.particles;
    return p.has.starts ? p.start : p.position;
  }

  /// `u`: of the particles from `begin` on.
  void moveRange(const CellGrid<D>& grid, const Watch& watch, std::uint32_t begin, std::uint32_t end, double dt,
                 std::span<const Vec<D>> u) {
    const std::uint32_t size = end - begin;
    const std::uint32_t out = moveParticles<D>(state_.context, grid, dt, starts().subspan(begin, size),
                                               u.first(size), state_.position.span().subspan(begin, size));
    if (out == noParticle) return;
    Particles<D> host;
    copyToHost(state_.context, state_.particles, host);
    if (host.has.starts) std::swap(host.position, host.start);
    Vec<D> uOut{};
    copyToHost(state_.context, u.subspan(out, 1), &uOut);
    if (std::isfinite(norm(uOut)))
      watch.requireSlow(state_.timeStep, norm(uOut));  // then it is not the domain that is too small
    throw RunError(describeLeaving<D>(state_.theCase, host, begin + out, uOut, state_.timeStep));
  }

  void takeMoved() {
    Particles<D, Backend>& p = state_.particles;
    const std::uint32_t walls = p.wallBegin();
    const std::span<const Vec<D>> moved = state_.position;
    copyValues(state_.context, moved.first(p.fluidCount), p.position.data());
    if (state_.wallsMove) copyValues(state_.context, moved.subspan(walls), p.position.data() + walls);
  }

  FlowState<D, Backend>& state_;
  MovingBodies<D, Backend>& bodies_;
};

}  // namespace treacle
