#include "import_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

namespace treacle {
namespace {

class BodyMaker {
 public:
  BodyMaker(ImportedCase& imported, const MphParameters& p, const MphGeometry& g,
            const std::array<int, mphTypes>& materialOf, const std::string& name)
      : imported_(imported), p_(p), g_(g), materialOf_(materialOf), name_(name) {}

  void addCuboids() {
    for (std::size_t k = 0; k < g_.cuboids.size(); ++k) {
      const MphCuboid& cuboid = g_.cuboids[k];
      Body& body = add(cuboid.type, fmt::format("{}-cuboid{}", nameOfMphType(cuboid.type), k + 1), cuboid.velocity,
                       fmt::format("{}:{}", g_.path, cuboid.line));
      body.shape.min = inPlane(cuboid.lower);
      body.shape.max = inPlane(cuboid.upper);
    }
  }

  void addParticles() {
    if (g_.particles.empty()) return;
    for (int type = 0; type < mphTypes; ++type) {
      if (materialOf_[static_cast<std::size_t>(type)] < 0) continue;
      const std::string typeName{nameOfMphType(type)};
      GivenParticles given = particlesOf(type);
      const bool same = std::ranges::adjacent_find(given.velocity, std::not_equal_to{}) == given.velocity.end();
      const Vec<3> velocity = same && !given.velocity.empty() ? given.velocity[0] : Vec<3>{};
      if (same) given.velocity.clear();
      Body& body = add(type, typeName + "-particles", velocity, g_.path);
      body.shape.kind = ShapeKind::Particles;
      body.shape.file.path = fmt::format("{}-{}.csv", name_, typeName);
      body.fileVelocities = !given.velocity.empty();
      imported_.tables.push_back({body.shape.file.path, tableText(given)});
      body.shape.file.particles.value = std::make_shared<const GivenParticles>(std::move(given));
    }
  }

  void noteWalls() {
    for (const MphCuboid& cuboid : g_.cuboids)
      if (cuboid.type >= firstMphWall) noteWall(cuboid.type, cuboid.lower, cuboid.velocity);
    for (const MphParticle& particle : g_.particles)
      if (particle.type >= firstMphWall) noteWall(particle.type, particle.position, particle.velocity);
  }

 private:
  Vec<3> inPlane(Vec<3> x) const {
    if (imported_.value.dimensions == 2) x[2] = 0;
    return x;
  }

  void note(const std::string& text) {
    if (std::ranges::find(imported_.warnings, text) == imported_.warnings.end())
      imported_.warnings.push_back(text);
  }

  Vec<3> flattened(const Vec<3>& x, const std::string& what) {
    if (inPlane(x) != x)
      note(fmt::format("{} has a part along z that is left out: the particles are one layer", what));
    return inPlane(x);
  }

  const MphWall& wallOf(int type) const { return p_.walls[static_cast<std::size_t>(type - firstMphWall)]; }

  Body& add(int type, const std::string& name, const Vec<3>& velocity, const std::string& place) {
    Body body;
    body.name = name;
    body.material = materialOf_[static_cast<std::size_t>(type)];
    if (type < firstMphWall) {
      body.velocity = flattened(velocity, fmt::format("{}: the velocity", place));
    } else {
      body.kind = BodyKind::Wall;
      setMotion(body, type);
    }
    imported_.value.bodies.push_back(body);
    return imported_.value.bodies.back();
  }

  void setMotion(Body& body, int type) {
    const MphWall& wall = wallOf(type);
    const std::string row = fmt::format("{}: the {{}} of Wall{}", p_.path, type);
    body.velocity = flattened(wall.velocity, fmt::format(fmt::runtime(row), "Velocity"));
    Rotation rotation;
    rotation.center = inPlane(wall.center);
    if (imported_.value.dimensions == 3) {
      rotation.axis = wall.omega;
      rotation.speed = norm(wall.omega);
    } else {
      rotation.speed = wall.omega[2];
      if (wall.omega[0] != 0 || wall.omega[1] != 0)
        note(
            fmt::format("{}: the Omega of Wall{} has parts along x and y that are left out: the particles are one "
                        "layer",
                        p_.path, type));
    }
    if (rotation.speed != 0) body.rotation = rotation;
  }

  /// What a wall is given in this file the parameters say better.
  void noteWall(int type, const Vec<3>& position, const Vec<3>& velocity) {
    const MphWall& wall = wallOf(type);
    const Vec<3> expected = wall.velocity + cross(wall.omega, position - wall.center);
    if (velocity != Vec<3>{} && norm(velocity - expected) > 1e-5 * norm(expected))
      note(fmt::format("{}: velocities of type {} are not those of the row Wall{} in {}, and left out", g_.path,
                       type, type, p_.path));
  }

  /// Of one type. Walls have no velocities of their own.
  GivenParticles particlesOf(int type) {
    GivenParticles given;
    for (const MphParticle& particle : g_.particles) {
      if (particle.type != type) continue;
      given.position.push_back(inPlane(particle.position));
      if (type < firstMphWall)
        given.velocity.push_back(flattened(particle.velocity, fmt::format("{}: the velocity", g_.path)));
    }
    return given;
  }

  std::string tableText(const GivenParticles& given) const {
    const bool plane = imported_.value.dimensions == 2;
    std::string text = plane ? "x,y" : "x,y,z";
    if (!given.velocity.empty()) text += plane ? ",vx,vy" : ",vx,vy,vz";
    const auto end = std::back_inserter(text);
    const auto add = [&](const Vec<3>& x, std::string_view before) {
      fmt::format_to(end, "{}{},{}", before, x[0], x[1]);
      if (!plane) fmt::format_to(end, ",{}", x[2]);
    };
    for (std::size_t k = 0; k < given.position.size(); ++k) {
      add(given.position[k], "\n");
      if (!given.velocity.empty()) add(given.velocity[k], ",");
    }
    return text + '\n';
  }

  ImportedCase& imported_;
  const MphParameters& p_;
  const MphGeometry& g_;
  const std::array<int, mphTypes>& materialOf_;
  const std::string& name_;
};

/// A cuboid of which nobody knows here how many particles the program would give it.
void noteFractions(ImportedCase& imported, const MphGeometry& g) {
  for (const MphCuboid& cuboid : g.cuboids)
    for (int k = 0; k < imported.value.dimensions; ++k)
      if (const double n = (cuboid.upper[k] - cuboid.lower[k]) / g.spacing; std::abs(n - std::round(n)) > 1e-6 * n)
        imported.warnings.push_back(
            fmt::format("{}:{}: the cuboid is {:.6g} Spacings long along {}, not a whole number: its particles "
                        "may be others than "
                        "those that are made of it (.grid), which can be imported",
                        g.path, cuboid.line, n, "xyz"[k]));
}

}  // namespace

void addBodies(ImportedCase& imported, const MphParameters& p, const MphGeometry& g,
               const std::array<int, mphTypes>& materialOf, const std::string& name) {
  BodyMaker maker(imported, p, g, materialOf, name);
  maker.addCuboids();
  maker.addParticles();
  maker.noteWalls();
  noteFractions(imported, g);
}

}  // namespace treacle
