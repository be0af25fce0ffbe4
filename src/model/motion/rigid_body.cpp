#include "treacle/model/motion/rigid_body.hpp"

#include "treacle/core/arithmetic.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

using Quaternion = std::array<double, 4>;

Quaternion product(const Quaternion& a, const Quaternion& b) {
  const Vec<3> u{a[1], a[2], a[3]}, v{b[1], b[2], b[3]};
  const Vec<3> w = a[0] * v + b[0] * u + cross(u, v);
  return {a[0] * b[0] - dot(u, v), w[0], w[1], w[2]};
}

}  // namespace

Vec<3> turnedBy(const Quaternion& q, const Vec<3>& v) {
  const Vec<3> u{q[1], q[2], q[3]};
  const Vec<3> t = 2.0 * cross(u, v);
  return v + q[0] * t + cross(u, t);
}

double RigidBody::gyration() const { return std::sqrt(std::max({inertia[0], inertia[1], inertia[2]}) / mass); }

Vec<3> RigidBody::inertiaTimes(const Vec<3>& v) const {
  const Vec<3> w = turnedBy({orientation[0], -orientation[1], -orientation[2], -orientation[3]}, v);
  const auto& i = inertia;
  return turnedBy(orientation, {i[0] * w[0] + i[3] * w[1] + i[4] * w[2], i[3] * w[0] + i[1] * w[1] + i[5] * w[2],
                                i[4] * w[0] + i[5] * w[1] + i[2] * w[2]});
}

double RigidBody::energy() const { return 0.5 * (mass * norm2(velocity) + dot(spin, inertiaTimes(spin))); }

void RigidBody::advance(double dt) {
  center = center + dt * velocity;
  const double angle = dt * norm(spin);
  if (angle == 0) return;
  const Vec<3> half = (0.5 * dt * sinc(angle / 2)) * spin;
  orientation = product({std::cos(angle / 2), half[0], half[1], half[2]}, orientation);
  double length = 0;
  for (const double x : orientation) length += x * x;
  for (double& x : orientation) x /= std::sqrt(length);
}

template <int D>
WallMotion<D> rigidMotion(const RigidBody& body, double dt) {
  WallMotion<D> m;
  m.velocity = resized<D>(body.velocity);
  m.center = resized<D>(body.center);
  m.spin = body.spin;
  const double angle = dt * norm(body.spin), half = sinc(angle / 2);
  m.along = sinc(angle);
  m.inwards = dt / 2 * half * half;
  const Vec<3> axis{body.orientation[1], body.orientation[2], body.orientation[3]};
  const double sine = norm(axis), cosine = body.orientation[0];  // of half the angle
  if (sine == 0) return m;
  m.axis = (1 / sine) * axis;
  m.sine = 2 * sine * cosine;
  m.cosine = cosine * cosine - sine * sine;
  return m;
}

template WallMotion<2> rigidMotion<2>(const RigidBody&, double);
template WallMotion<3> rigidMotion<3>(const RigidBody&, double);

}  // namespace treacle
