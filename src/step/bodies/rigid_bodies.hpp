#pragma once

#include "affine_solve.hpp"
#include "given_forces.hpp"
#include "method/flow_unknowns.hpp"
#include "moving_bodies.hpp"
#include "treacle/model/motion/friction.hpp"
#include "treacle/step/bodies/contacts.hpp"
#include "treacle/step/readings/balance_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace treacle {

/// The velocities of rigid bodies as unknowns of a step: those at which the forces of the fluid, which depend on
/// them by way of its own velocities, and of gravity accelerate the bodies to them. Both are of the end of the
/// step, so that a light body in a stiff fluid is as stable as the fluid is.
template <int D, class Backend>
class RigidSystem final : public FlowUnknowns {
 public:
  /// `state` must outlive this.
  explicit RigidSystem(FlowState<D, Backend>& state) : state_(state) {}

  /// The bodies of the step at hand start with the velocities that they had, changed as in the last step, and so
  /// do their walls.
  void start() {
    findUnknowns();
    state_.rigid = state_.particles.rigid;
    for (RigidBody& b : state_.rigid.bodies)
      if (b.mass > 0) b.advance(early());
    std::vector<double> x = values();
    if (state_.rigid.change.size() == x.size())
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += state_.rigid.change[k];
    set(x);
  }

  /// `loads()`: what bodies bear of the flow at hand, for missing().
  void setLoads(std::function<std::vector<LoadSums>()> loads) { loads_ = std::move(loads); }

  std::string name() const override { return "the velocities of the rigid bodies"; }
  std::vector<double> values() const override { return values(state_.rigid.bodies); }
  std::vector<double> scales() const override { return std::vector(unknowns_.size(), scaleOf(values())); }
  void set(std::span<const double> x) override {
    setBodies(x);
    setWallMotions(state_);
  }
  std::vector<double> missing() override { return residual(loads_()); }

  /// The velocities of the last flow are those of the step.
  void keepChange() {
    const std::vector<double> x = values(), before = values(state_.particles.rigid.bodies);
    state_.rigid.change.resize(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) state_.rigid.change[k] = x[k] - before[k];
  }

  /// Contacts of bodies with each other and with walls push them apart and do not hold them: that no surfaces that
  /// touch go into each other, in the step at hand, and that those that do come apart: of an overlap a fifth in a
  /// step, at most a hundredth of a spacing, which takes no energy worth naming. Among `all` unknowns of the step
  /// the bodies' are the first.
  std::vector<Restraint> restraints(const std::vector<Contact<D>>& contacts, std::size_t all) const {
    std::vector<Restraint> restraints = restraintsOf(contacts);
    for (Restraint& r : restraints) {
      r.row.resize(all), r.push.resize(all);
      for (Restraint::Slide& slide : r.slides) slide.row.resize(all), slide.push.resize(all);
    }
    return restraints;
  }

 private:
  static constexpr int ofHinge = 6;
  struct Unknown {
    std::size_t body;
    int component;  // 0 to 2: velocity, 3 to 5: spin times the radius of gyration; that about its hinge likewise
  };

  /// What a hinge leaves to a body.
  struct Turn {
    Vec<3> axis, point;
    double inertia;  // about it [kg m2]

    static Turn of(const Hinge& hinge, const RigidBody& b) {
      const Vec<3> axis = hinge.direction();
      return {axis, hinge.point,
              dot(axis, b.inertiaTimes(axis)) + b.mass * norm2(cross(axis, b.center - hinge.point))};
    }
    double gyration(const RigidBody& b) const { return std::sqrt(inertia / b.mass); }
  };

  Turn turnOf(std::size_t body) const {
    return Turn::of(*state_.theCase.bodies[body].rigid.hinge, state_.particles.rigid.bodies[body]);
  }

  /// Those of the bodies that are let go.
  void findUnknowns() {
    unknowns_.clear();
    const Case& c = state_.theCase;
    for (std::size_t b = 0; b < c.bodies.size(); ++b) {
      const RigidSettings& r = c.bodies[b].rigid;
      if (c.bodies[b].kind != BodyKind::Rigid || state_.time < r.release - 0.5 * state_.timeStep) continue;
      if (r.hinge) {
        unknowns_.push_back({b, ofHinge});
        continue;
      }
      for (int k = 0; k < D; ++k)
        if (r.translates[static_cast<std::size_t>(k)]) unknowns_.push_back({b, k});
      for (int k = D == 2 ? 2 : 0; k < 3; ++k)
        if (r.rotates[static_cast<std::size_t>(k)]) unknowns_.push_back({b, 3 + k});
    }
  }

  std::vector<double> values(const std::vector<RigidBody>& bodies) const {
    std::vector<double> x;
    for (const Unknown& u : unknowns_) {
      const RigidBody& b = bodies[u.body];
      if (u.component == ofHinge) {
        const Turn turn = turnOf(u.body);
        x.push_back(dot(b.spin, turn.axis) * turn.gyration(b));
      } else {
        x.push_back(u.component < 3 ? b.velocity[u.component] : b.spin[u.component - 3] * b.gyration());
      }
    }
    return x;
  }

  void setBodies(std::span<const double> x) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      RigidBody& b = state_.rigid.bodies[unknowns_[k].body];
      const int component = unknowns_[k].component;
      if (component == ofHinge)
        turnOnHinge(unknowns_[k].body, x[k], b);
      else if (component < 3)
        b.velocity[component] = x[k];
      else
        b.spin[component - 3] = x[k] / b.gyration();
    }
  }

  /// The velocity is that of the way that the centre takes in the step, which ends where the hinge has it.
  void turnOnHinge(std::size_t body, double x, RigidBody& b) const {
    const RigidBody& before = state_.particles.rigid.bodies[body];
    const Turn turn = turnOf(body);
    b.spin = (x / turn.gyration(before)) * turn.axis;
    RigidBody turned = before;
    turned.orientation = {1, 0, 0, 0}, turned.velocity = {}, turned.spin = b.spin;
    turned.advance(state_.timeStep);
    const Vec<3> arm = before.center - turn.point;
    b.velocity = (1 / state_.timeStep) * (turnedBy(turned.orientation, arm) - arm);
  }

  std::vector<Restraint> restraintsOf(const std::vector<Contact<D>>& contacts) const {
    if (contacts.empty()) return {};
    const double dt = state_.timeStep, most = 0.01 * state_.theCase.spacing;
    const double least = 4 * dt * norm(state_.theCase.gravity);  // of an impact: what rests does not bounce [m/s]
    const std::vector<WallMotion<D>> motion = bodyMotions(state_);
    std::vector<Restraint> all;
    for (const Contact<D>& contact : contacts) {
      const double gap = contact.gap - early() * opening(contact, motion[contact.other]);
      const double speed = opening(contact, motion[contact.other]);
      double apart = (gap > 0 ? -gap : std::min(-0.2 * gap, most)) / dt;
      if (const double part = bounce(contact); part > 0 && gap + dt * speed <= 0 && -speed > least)
        apart = std::max(apart, -speed * part);
      all.push_back(along(contact, contact.place, contact.normal, motion[contact.other], apart));
      addFriction(contact, motion[contact.other], all.back());
    }
    return all;
  }

  double bounce(const Contact<D>& contact) const {
    return restitutionBetween(state_.theCase.bodies[contact.body], state_.theCase.bodies[contact.other]);
  }

  /// By how much of a step the bodies have gone on to where their walls are [s].
  double early() const { return state_.theCase.middleShare() * state_.timeStep; }

  /// How fast the gap of a contact has opened since the start of the step [m/s].
  double opening(const Contact<D>& contact, const WallMotion<D>& other) const {
    const auto speed = [&](const Vec<3>& velocity) { return dot(resized<3>(contact.normal), velocity); };
    const auto before = [&](std::size_t b) {
      const RigidBody& body = state_.particles.rigid.bodies[b];
      return speed(body.velocity + cross(body.spin, resized<3>(contact.place) - state_.rigid.bodies[b].center));
    };
    return before(contact.body) - (state_.theCase.bodies[contact.other].kind == BodyKind::Rigid
                                       ? before(contact.other)
                                       : speed(resized<3>(other.chordAt(contact.place))));
  }

  /// Surfaces that are pressed together do not slide on each other, as far as friction holds them. Of all contacts
  /// of two bodies it acts in the surface of the same one, so that one that turns as it comes down on a plane, and
  /// touches it at both ends in a step, can stand still at both; that of the particle is half a spacing from it.
  void addFriction(const Contact<D>& contact, const WallMotion<D>& other, Restraint& r) const {
    r.grip = frictionBetween(state_.theCase.bodies[contact.body], state_.theCase.bodies[contact.other]);
    if (r.grip == 0) return;
    const bool own = state_.theCase.bodies[contact.other].kind == BodyKind::Rigid && contact.body > contact.other;
    const Vec<D> place = contact.place - (0.5 * state_.theCase.spacing + (own ? 0 : contact.gap)) * contact.normal;
    for (const Vec<D>& tangent : tangents(contact.normal)) {
      Restraint held = along(contact, place, tangent, other, 0);
      r.slides.push_back({std::move(held.row), std::move(held.push), held.least});
    }
  }

  static std::array<Vec<D>, D - 1> tangents(const Vec<D>& normal) {
    if constexpr (D == 2) {
      return {Vec<2>{-normal[1], normal[0]}};
    } else {
      int axis = 0;  // the one that is the farthest from the normal
      for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
      Vec<3> unit{};
      unit[axis] = 1;
      const Vec<3> across = cross(normal, unit), first = (1 / norm(across)) * across;
      return {first, cross(normal, first)};
    }
  }

  /// That the body goes along a direction, relative to the other one at a place, with at least `least`.
  Restraint along(const Contact<D>& contact, const Vec<D>& place, const Vec<D>& direction,
                  const WallMotion<D>& other, double least) const {
    Restraint r{std::vector<double>(unknowns_.size()), std::vector<double>(unknowns_.size()), least};
    add(contact.body, resized<3>(place), resized<3>(direction), r);
    if (state_.theCase.bodies[contact.other].kind == BodyKind::Rigid)
      add(contact.other, resized<3>(place), -1.0 * resized<3>(direction), r);
    else
      r.least += dot(resized<3>(direction), resized<3>(other.chordAt(place)));
    return r;
  }

  /// The part of a body: its velocity at a place along a direction, less what is locked, and what a force there
  /// along it makes of the residual.
  void add(std::size_t body, const Vec<3>& place, const Vec<3>& direction, Restraint& r) const {
    const RigidBody& b = state_.rigid.bodies[body];
    const RigidBody& before = state_.particles.rigid.bodies[body];
    const Vec<3> arm = place - b.center, turn = cross(arm, direction);
    const double free = 1 + norm2(turn) / (b.gyration() * b.gyration());
    if (state_.theCase.bodies[body].rigid.hinge) {
      addTurn(body, place, direction, r);
    } else {
      r.least -= dot(direction, before.velocity + cross(before.spin, arm));
      for (std::size_t k = 0; k < unknowns_.size(); ++k) {
        if (unknowns_[k].body != body) continue;
        const int component = unknowns_[k].component;
        r.row[k] = component < 3 ? direction[component] : turn[component - 3] / b.gyration();
        r.push[k] = r.row[k] / b.mass;
        r.least += component < 3 ? direction[component] * before.velocity[component]
                                 : turn[component - 3] * before.spin[component - 3];
      }
    }
    leaveOutLocked(body, free, r);
  }

  /// A body that cannot go along the direction, but for the rounding of it, has no part in it: what it would take
  /// to push it that way were without bounds. `free`: its mass times what a force there along the direction
  /// accelerates if nothing is locked.
  void leaveOutLocked(std::size_t body, double free, Restraint& r) const {
    constexpr double least = 1e-3;  // of the speed of the free body; faces of meshes are off by up to 1e-4
    double left = 0;                // the same with what is locked
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (unknowns_[k].body == body) left += r.row[k] * r.row[k];
    if (left > least * least * free) return;
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (unknowns_[k].body == body) r.row[k] = 0, r.push[k] = 0;
  }

  /// The same of a body on a hinge, on which nothing else is locked.
  void addTurn(std::size_t body, const Vec<3>& place, const Vec<3>& direction, Restraint& r) const {
    const RigidBody& b = state_.rigid.bodies[body];
    const Turn turn = turnOf(body);
    for (std::size_t k = 0; k < unknowns_.size(); ++k) {
      if (unknowns_[k].body != body) continue;
      r.row[k] = dot(cross(turn.axis, place - turn.point), direction) / turn.gyration(b);
      r.push[k] = r.row[k] / b.mass;
    }
  }

  /// Speeds that count in a step [m/s]: those at hand, and those that a body without fluid would take.
  double scaleOf(const std::vector<double>& x) const {
    double scale =
        norm(state_.theCase.gravity) * state_.velocityStep + 1e-6 * state_.theCase.spacing / state_.timeStep;
    for (const double v : x) scale = std::max(scale, std::abs(v));
    for (const double v : residual(std::vector<LoadSums>(state_.theCase.bodies.size())))
      scale = std::max(scale, std::abs(v));
    return scale;
  }

  /// What is missing for the velocities, over the masses [m/s].
  std::vector<double> residual(const std::vector<LoadSums>& loads) const {
    const double dt = state_.velocityStep;
    std::vector<double> r;
    const std::vector<GivenForces> givens =
        givenForces(state_.theCase, state_.particles.rigid.bodies, state_.rigid.bodies, interval());
    for (const Unknown& u : unknowns_) {
      const RigidBody &b = state_.rigid.bodies[u.body], &before = state_.particles.rigid.bodies[u.body];
      const LoadSums& load = loads[u.body];
      const GivenForces& given = givens[u.body];
      const Vec<3> weight = b.mass * state_.theCase.gravity;
      if (u.component == ofHinge) {
        const Turn turn = turnOf(u.body);
        const Vec<3> torque =
            load.torque - cross(turn.point, load.force) + given.torque +
            cross(forcePlace(before, b, state_.timeStep).center - turn.point, weight + given.force);
        r.push_back((turn.inertia * dot(turn.axis, b.spin - before.spin) - dt * dot(turn.axis, torque)) /
                    (b.mass * turn.gyration(b)));
        continue;
      }
      if (u.component < 3) {
        const double force = (load.force + weight + given.force)[u.component];
        r.push_back(b.velocity[u.component] - before.velocity[u.component] - dt * force / b.mass);
        continue;
      }
      // The inertia is that of where the body is, about axes that rest.
      const Vec<3> torque = load.torque - cross(b.center, load.force) + given.torque -
                            cross(before.spin, b.inertiaTimes(before.spin));
      const Vec<3> change = b.inertiaTimes(b.spin - before.spin) - dt * torque;
      r.push_back(change[u.component - 3] / (b.mass * b.gyration()));
    }
    return r;
  }

  ForceInterval interval() const {
    const auto [from, to] = state_.velocityInterval();
    return {from, to, state_.timeStep};
  }

  FlowState<D, Backend>& state_;
  std::vector<Unknown> unknowns_;
  std::function<std::vector<LoadSums>()> loads_;
};

}  // namespace treacle
