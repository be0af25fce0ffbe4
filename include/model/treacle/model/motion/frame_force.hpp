#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/opening.hpp"

#include <span>

namespace treacle {

/// What acts on the fluid in a step by its place and velocity: gravity, the pressures of openings and, in a frame
/// that turns, centrifugal, Euler and Coriolis forces. Velocities are those in the frame.
template <int D>
struct FrameForce {
  Vec<D> gravity{};                             // as the frame sees it [m/s2]
  bool turns = false;                           // else the rest does not count
  Vec<D> center{};                              // a point of the axis [m]
  Vec<3> spin{};                                // omega [rad/s]
  Vec<3> spinChange{};                          // d omega / dt [rad/s2]
  Vec<3> axis{};                                // of length 1
  std::span<const OpeningForce<D>> openings{};  // in the backend's memory
  double sine = 0, cosine = 1;  // of the angle 2 omega dt that Coriolis forces turn a velocity back by in the step

  /// Without openings. Over a time from `from` to `to`, in which velocities change [s]; from == to: at that time.
  static FrameForce of(const Case& c, double from, double to);

  /// On what rests at x, with the acceleration of the frame's rotation at x taken off [m/s2].
  TREACLE_HD Vec<D> at(const Vec<D>& x) const {
    if (!turns) return gravity;
    const Vec<D> d = x - center;
    return gravity - product(spinChange, d) - product(spin, product(spin, d));
  }
  /// On what has a density [kg/m3] and rests at x [N/m3].
  TREACLE_HD Vec<D> on(const Vec<D>& x, double density) const {
    const Vec<D> weight = at(x);
    Vec<D> force = density * weight;
    for (const OpeningForce<D>& o : openings) force += o.at(x, density, weight, drop(o.center, x));
    return force;
  }
  /// On a density that is there beside it, such as that of warm fluid [N/m3].
  TREACLE_HD Vec<D> onFurther(const Vec<D>& x, double density) const {
    const Vec<D> weight = at(x);
    Vec<D> force = density * weight;
    for (const OpeningForce<D>& o : openings) force += o.ofWeight(x, density, weight, drop(o.center, x));
    return force;
  }
  /// A velocity after the Coriolis force -2 omega x u of the step, which turns it and takes no energy [m/s].
  TREACLE_HD Vec<D> turned(const Vec<D>& u) const {
    if (!turns) return u;
    const Vec<D> across = product(axis, u);
    return u - sine * across + (1 - cosine) * product(axis, across);
  }
  /// -|omega x d|^2 / 2, the potential of the centrifugal force at x, less g.x [m2/s2].
  TREACLE_HD double potential(const Vec<D>& x) const {
    return -dot(gravity, x) - (turns ? 0.5 * norm2(product(spin, x - center)) : 0);
  }

 private:
  /// potential(from) - potential(to)
  TREACLE_HD double drop(const Vec<D>& from, const Vec<D>& to) const {
    const double fall = dot(gravity, to - from);
    return turns ? fall + 0.5 * (norm2(product(spin, to - center)) - norm2(product(spin, from - center))) : fall;
  }
  TREACLE_HD static Vec<D> product(const Vec<3>& w, const Vec<D>& d) {
    if constexpr (D == 2)
      return {-w[2] * d[1], w[2] * d[0]};
    else
      return cross(w, d);
  }
};

extern template struct FrameForce<2>;
extern template struct FrameForce<3>;

}  // namespace treacle
