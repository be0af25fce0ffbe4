#include "support/isph_cases.hpp"

#include "treacle/model/particles/create.hpp"
#include "treacle/model/particles/particles_copy.hpp"

#include <gtest/gtest.h>
#include <unordered_map>

#include <algorithm>
#include <string>

namespace treacle::test {

Case tankCase(int dimensions, double width, double depth) {
  const double height = 2 * depth + 4, corner = tankCorner, wall = tankWall;
  const int up = dimensions - 1;
  Case c = waterCase(dimensions, Vec<3>::filled(std::max(width, height) + 2 * corner));
  c.method.isph.alpha = 0.05;
  c.gravity[up] = -9.81;
  Vec<3> min{}, max{};
  for (int k = 0; k < dimensions; ++k) {
    min[k] = corner * c.spacing;
    max[k] = (corner + (k == up ? depth : width)) * c.spacing;
  }
  const auto add = [&](const char* name, BodyKind kind, const Vec<3>& from, const Vec<3>& to) {
    Body body;
    body.name = name;
    body.kind = kind;
    body.shape.min = from;
    body.shape.max = to;
    c.bodies.push_back(body);
  };
  add("pool", BodyKind::Fluid, min, max);
  const double thick = wall * c.spacing, rim = (corner + height) * c.spacing;
  Vec<3> outerMin = min, outerMax = max;
  for (int k = 0; k < up; ++k) outerMin[k] -= thick, outerMax[k] += thick;
  Vec<3> from = outerMin, to = outerMax;
  from[up] = min[up] - thick, to[up] = min[up];
  add("floor", BodyKind::Wall, from, to);
  // Each pair of sides between those before.
  for (int axis = 0; axis < up; ++axis)
    for (const bool upper : {false, true}) {
      from = outerMin, to = outerMax;
      from[up] = min[up], to[up] = rim;
      for (int k = 0; k < axis; ++k) from[k] = min[k], to[k] = max[k];
      (upper ? from[axis] : to[axis]) = upper ? max[axis] : min[axis];
      add(upper ? "upper side" : "lower side", BodyKind::Wall, from, to);
    }
  return c;
}

template <int D>
Particles<D> created(const Case& c) {
  std::vector<std::string> notes;
  Particles<D> p = createParticles<D>(c, notes);
  for (const std::string& note : notes) ADD_FAILURE() << note;
  return p;
}

template <int D>
Particles<D> copyOf(const Particles<D>& from) {
  Particles<D> p;
  p.resize(from.numbers());
  forEachFieldOf([](const auto& a, auto& b) { std::copy(a.begin(), a.end(), b.begin()); }, from, p);
  p.copyNumbers(from);
  return p;
}

template <int D>
Vec<D> meanVelocity(const Particles<D>& p) {
  return fluidMean(p, [&](std::uint32_t i) { return p.velocity[i]; });
}

template <int D>
Vec<D> centreOfMass(const Particles<D>& p) {
  return fluidMean(p, [&](std::uint32_t i) { return p.position[i]; });
}

template <int D>
bool sameBits(const Particles<D>& a, const Particles<D>& b) {
  if (a.count != b.count || a.fluidCount != b.fluidCount) return false;
  std::unordered_map<std::uint32_t, std::uint32_t> placeOf;
  for (std::uint32_t i = 0; i < a.count; ++i) placeOf[a.id[i]] = i;
  for (std::uint32_t i = 0; i < b.count; ++i) {
    const auto place = placeOf.find(b.id[i]);
    if (place == placeOf.end()) return false;
    const std::uint32_t j = place->second;
    if (!(a.position[j] == b.position[i] && a.velocity[j] == b.velocity[i] && a.pressure[j] == b.pressure[i] &&
          a.numberDensity[j] == b.numberDensity[i]))
      return false;
  }
  return true;
}

template Particles<2> created(const Case&);
template Particles<2> copyOf(const Particles<2>&);
template Vec<2> meanVelocity(const Particles<2>&);
template Vec<2> centreOfMass(const Particles<2>&);
template bool sameBits(const Particles<2>&, const Particles<2>&);
template Particles<3> created(const Case&);
template Particles<3> copyOf(const Particles<3>&);
template Vec<3> meanVelocity(const Particles<3>&);
template Vec<3> centreOfMass(const Particles<3>&);
template bool sameBits(const Particles<3>&, const Particles<3>&);

}  // namespace treacle::test
