#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cmath>

namespace treacle {

/// The rigid motion of a wall in one step. Its particles go by the chords of their arcs, so that they stay on
/// their circles; the fluid meets the velocities of the rigid motion where the particles are, which have no
/// divergence and no part towards the centre.
template <int D>
struct WallMotion {
  Vec<D> velocity{};            // of the centre, mean over the step [m/s]
  Vec<D> acceleration{};        // of the centre, at the end of the step [m/s2]
  Vec<D> center{};              // at the start of the step [m]
  Vec<D> period{};              // of the domain, 0 on open axes [m]
  Vec<3> spin{};                // omega [rad/s]
  Vec<3> spinChange{};          // of a rigid body: of omega over the step, over dt [rad/s2]
  double along = 1;             // sin(omega dt) / (omega dt)
  double inwards = 0;           // (1 - cos(omega dt)) / (omega^2 dt) [s]
  Vec<3> axis{};                // of the rotation, of length 1
  double sine = 0, cosine = 1;  // of the angle turned from t = 0 to the start of the step

  /// From the nearest image of the centre to x [m].
  TREACLE_HD Vec<D> arm(const Vec<D>& x) const {
    Vec<D> d = x - center;
    for (int k = 0; k < D; ++k)
      if (period[k] > 0) d[k] -= period[k] * std::rint(d[k] / period[k]);
    return d;
  }
  /// omega x d
  TREACLE_HD Vec<D> swirl(const Vec<D>& d) const { return product(spin, d); }
  /// w x d
  template <class T>
  TREACLE_HD static Vec<D, T> product(const Vec<3>& w, const Vec<D, T>& d) {
    if constexpr (D == 2)
      return {-w[2] * d[1], w[2] * d[0]};
    else
      return {w[1] * d[2] - w[2] * d[1], w[2] * d[0] - w[0] * d[2], w[0] * d[1] - w[1] * d[0]};
  }

  /// At x at the start of the step [m/s].
  TREACLE_HD Vec<D> velocityAt(const Vec<D>& x) const { return velocity + swirl(arm(x)); }
  /// By what dt is multiplied to give the way of a particle at x [m/s].
  TREACLE_HD Vec<D> chordAt(const Vec<D>& x) const {
    const Vec<D> u = swirl(arm(x));
    return velocity + along * u + inwards * swirl(u);
  }
  /// A vector of the wall as it was at t = 0, turned with the wall to the start of the step.
  TREACLE_HD Vec<D> turned(const Vec<D>& v) const {
    if constexpr (D == 2) {
      const double s = axis[2] * sine;
      return {cosine * v[0] - s * v[1], s * v[0] + cosine * v[1]};
    } else {
      return cosine * v + sine * cross(axis, v) + ((1 - cosine) * dot(axis, v)) * axis;
    }
  }
  /// Of a particle at x [m/s2].
  TREACLE_HD Vec<D> accelerationAt(const Vec<D>& x) const {
    const Vec<D> d = arm(x);
    return acceleration + product(spinChange, d) + swirl(swirl(d));
  }
};

/// Mean velocity of a wall, or of its centre if it rotates, in the step of dt from time t on [m/s]: the walls are
/// where their motion puts them at the end of each step. With dt = 0 that at time t.
Vec<3> wallVelocity(const Body& body, double t, double dt);
/// The speed of its rotation, mean over dt from time t on, with dt = 0 that at time t [rad/s].
double wallSpin(const Body& body, double t, double dt = 0);
/// Whether a vector changes.
bool isDriven(const TimeVector& f);
/// From where a wall, or its centre if it rotates, or a nozzle starts to where it is at time t [m].
Vec<3> wallDisplacement(const Body& body, double t);
/// The point that a wall which rotates turns about, at time t; of others the origin [m].
Vec<3> wallCenter(const Body& body, double t);
/// The acceleration of a wall, or of its centre, at time t [m/s2].
Vec<3> wallAcceleration(const Body& body, double t);

/// Whether the velocity of some wall of the case changes without its turning; whether some wall turns.
bool someWallIsDriven(const Case& c);
bool someWallRotates(const Case& c);

/// All of a wall's motion in that step.
template <int D>
WallMotion<D> wallMotion(const Domain& domain, const Body& body, double t, double dt);

extern template WallMotion<2> wallMotion<2>(const Domain&, const Body&, double, double);
extern template WallMotion<3> wallMotion<3>(const Domain&, const Body&, double, double);

}  // namespace treacle
