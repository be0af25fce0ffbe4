#pragma once

#include "treacle/core/error.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace treacle {

/// Masses, centres and inertia of the rigid bodies of a case from the wall particles that it makes of them, of
/// which each process has a part; each particle is a cube of the spacing. Collective.
template <int D>
std::vector<RigidBody> rigidBodies(const Case& c, const Processes& processes, const Particles<D>& p) {
  std::vector<RigidBody> bodies(c.bodies.size());
  const double volume = std::pow(c.spacing, D);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = c.bodies[b];
    if (body.kind != BodyKind::Rigid) continue;
    const auto sum = [&]<std::size_t N>(auto&& term) {
      std::array<double, N> sums{};
      for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
        if (p.body[i] == b) term(resized<3>(p.position[i]), sums);
      sumOverProcesses(processes, std::span<double>(sums));
      return sums;
    };
    const auto first = sum.template operator()<4>([](const Vec<3>& x, auto& s) {
      s[0] += 1;
      for (int k = 0; k < 3; ++k) s[static_cast<std::size_t>(k) + 1] += x[k];
    });
    if (first[0] == 0) throw InputError(fmt::format("rigid body '{}' has no particles", body.name));
    RigidBody& r = bodies[b];
    r.center = (1 / first[0]) * Vec<3>{first[1], first[2], first[3]};
    const double whole = first[0] * volume * c.materials[static_cast<std::size_t>(body.material)].density;
    r.mass = body.rigid.mass > 0 ? body.rigid.mass : whole;
    const double each = r.mass / first[0], own = c.spacing * c.spacing / 6;
    const auto second = sum.template operator()<6>([&](const Vec<3>& x, auto& s) {
      const Vec<3> d = x - r.center;
      const double xx = d[0] * d[0], yy = d[1] * d[1], zz = d[2] * d[2];
      s[0] += yy + zz + own, s[1] += xx + zz + own, s[2] += xx + yy + own;
      s[3] -= d[0] * d[1], s[4] -= d[0] * d[2], s[5] -= d[1] * d[2];
    });
    for (std::size_t k = 0; k < 6; ++k) r.inertia[k] = each * second[k];
    r.velocity = body.velocity;
    r.spin = body.rigid.angularVelocity;
  }
  return bodies;
}

}  // namespace treacle
