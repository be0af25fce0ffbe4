#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <span>

namespace treacle {

/// What the fluid particles remember of their motion (Particles::acceleration, jerk), in the backend's memory.
template <int D>
struct FlowMemory {
  std::span<Vec<D>> acceleration;  // [m/s2]
  std::span<Vec<D>> jerk;          // [m/s3]
};

/// The velocity one step on, extrapolated in the frame that moves with the particle: Newton's polynomial through
/// the last two or three velocities, which may be any steps apart.
template <int D>
struct Extrapolation {
  double linear, quadratic;  // [s], [s2]

  /// Over a step of dt after one of lastStep [s].
  static Extrapolation make(FirstGuess order, double dt, double lastStep) {
    return {order == FirstGuess::Last ? 0 : dt, order == FirstGuess::Quadratic ? 0.5 * dt * (dt + lastStep) : 0};
  }

  TREACLE_HD Vec<D> operator()(const Vec<D>& u, const Vec<D>& acceleration, const Vec<D>& jerk) const {
    return u + linear * acceleration + quadratic * jerk;
  }
};

/// The derivatives of a particle's motion after a step.
template <int D>
struct MotionDerivatives {
  Vec<D> acceleration, jerk;

  /// After a step of dt that followed one of lastStep [s]. The accelerations are those in the middle of the steps.
  /// A zero acceleration is one that is not known: a jerk would be that of no motion to motion.
  TREACLE_HD static MotionDerivatives make(double dt, double lastStep, const Vec<D>& before, const Vec<D>& after,
                                           const Vec<D>& lastAcceleration) {
    MotionDerivatives r{(after - before) * (1 / dt), {}};
    if (norm2(lastAcceleration) > 0) r.jerk = (r.acceleration - lastAcceleration) * (2 / (dt + lastStep));
    return r;
  }
};

/// First guess of a solve per fluid particle [m/s], from the velocities u of the last step.
template <int D, class Backend>
void extrapolate(Context<Backend>&, const Extrapolation<D>&, std::span<const Vec<D>> u, FlowMemory<D>,
                 std::span<Vec<D>> guess);

/// Brings the memory of the fluid particles up to date after a step of dt that followed one of lastStep [s], with
/// their velocities before and after it.
template <int D, class Backend>
void updateFlowMemory(Context<Backend>&, double dt, double lastStep, std::span<const Vec<D>> before,
                      std::span<const Vec<D>> after, FlowMemory<D>);

}  // namespace treacle
