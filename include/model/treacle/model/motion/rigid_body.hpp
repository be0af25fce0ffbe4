#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <array>
#include <vector>

namespace treacle {

/// A body that the fluid and gravity move, as it is at one time. In two dimensions it turns about z, and mass and
/// inertia are per metre of depth.
struct RigidBody {
  double mass = 0;                                // [kg]; 0: of a body that is not rigid
  std::array<double, 6> inertia{};                // about the centre, at the start: xx, yy, zz, xy, xz, yz [kg m2]
  Vec<3> center{};                                // of mass [m]
  Vec<3> velocity{}, spin{};                      // [m/s], [rad/s]
  std::array<double, 4> orientation{1, 0, 0, 0};  // since the start: a quaternion of length 1, real part first

  /// Root of the largest moment of inertia over the mass: velocities of the body's parts are of the size of that
  /// times the spin [m].
  double gyration() const;
  /// The inertia as the body stands now, times a vector.
  Vec<3> inertiaTimes(const Vec<3>& v) const;
  /// Kinetic energy [J].
  double energy() const;
  /// Goes on for dt with its velocities [s].
  void advance(double dt);

  bool operator==(const RigidBody&) const = default;
};

/// The rigid bodies of a state, and what the search for their velocities remembers.
struct RigidMotion {
  std::vector<RigidBody> bodies{};  // per body of the case; empty: none is rigid, or nothing is known
  std::vector<double> change{};     // of the velocities in the last step (RigidSystem); empty: not known

  bool operator==(const RigidMotion&) const = default;
};

/// v turned by a quaternion of length 1.
Vec<3> turnedBy(const std::array<double, 4>& q, const Vec<3>& v);

/// Its motion in a step of dt.
template <int D>
WallMotion<D> rigidMotion(const RigidBody& body, double dt);

extern template WallMotion<2> rigidMotion<2>(const RigidBody&, double);
extern template WallMotion<3> rigidMotion<3>(const RigidBody&, double);

}  // namespace treacle
