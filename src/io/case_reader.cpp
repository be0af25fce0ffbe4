#include "treacle/io/case_reader.hpp"

#include "case_document.hpp"
#include "case_section.hpp"
#include "case_settings.hpp"
#include "case_width.hpp"
#include "treacle/model/shape.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

using Keys = std::vector<std::string_view>;

Domain readDomain(const Section& top, int dimensions) {
  const Section s = top.required("domain", {"min", "max", "periodic"});
  Domain domain;
  domain.min = s.vector("min", dimensions, "m");
  domain.max = s.vector("max", dimensions, "m");
  domain.periodic = s.flags("periodic", dimensions);
  for (int k = 0; k < dimensions; ++k)
    if (!(domain.min[k] < domain.max[k]))
      throw s.error("max", fmt::format("expected more than min on every axis, found {} <= {} along {}",
                                       domain.max[k], domain.min[k], "xyz"[k]));
  return domain;
}

Material readMaterial(const toml::table& table, const std::string& name, MethodKind method) {
  const Keys mphKeys{"bulk_viscosity", "bulk_modulus"};
  const bool isph = method == MethodKind::Isph;
  Keys keys{"name", "density", "dynamic_viscosity"};
  if (!isph) keys.insert(keys.end(), mphKeys.begin(), mphKeys.end());
  const Section s(table, fmt::format("[[material]] '{}'", name), keys,
                  isph ? keysOf(MethodKind::MphI, mphKeys) : ForeignKeys{});
  Material m;
  m.name = name;
  m.density = s.number("density", Bound::Positive, "kg/m3");
  m.dynamicViscosity = s.number("dynamic_viscosity", Bound::NonNegative, "Pa s");
  if (isph) return m;
  m.bulkViscosity = s.number("bulk_viscosity", Bound::NonNegative, "Pa s");
  m.bulkModulus = s.number("bulk_modulus", Bound::NonNegative, "Pa");
  return m;
}

std::vector<Material> readMaterials(const Section& top, MethodKind method) {
  std::vector<Material> materials;
  for (const toml::table* table : top.tables("material"))
    materials.push_back(readMaterial(*table, (*table)["name"].value_or(std::string{}), method));
  if (materials.size() > maxMaterials)
    throw top.error("material", fmt::format("expected at most {}, found {}", maxMaterials, materials.size()));
  return materials;
}

void readBox(const Section& s, int dimensions, Shape& shape) {
  shape.min = s.vector("min", dimensions, "m");
  shape.max = s.vector("max", dimensions, "m");
  for (int k = 0; k < dimensions; ++k)
    if (!(shape.min[k] < shape.max[k]))
      throw s.error("max", fmt::format("expected more than min on every axis, found {} <= {} along {}",
                                       shape.max[k], shape.min[k], "xyz"[k]));
}

void readRadii(const Section& s, Shape& shape) {
  shape.radius = s.number("radius", Bound::Positive, "m");
  shape.innerRadius = s.number("inner_radius", Bound::NonNegative, "m", 0.0);
  if (shape.innerRadius >= shape.radius)
    throw s.error("inner_radius",
                  fmt::format("expected less than radius = {}, found {}", shape.radius, shape.innerRadius));
}

Oscillation readOscillation(const Section& body, const std::string& name, int dimensions) {
  const Section s = body.section("oscillation", fmt::format("the oscillation of [[body]] '{}'", name),
                                 {"amplitude", "period", "phase"});
  Oscillation oscillation;
  oscillation.amplitude = s.vector("amplitude", dimensions, "m");
  oscillation.period = s.number("period", Bound::Positive, "s");
  oscillation.phase = s.number("phase", Bound::Any, "rad", oscillation.phase);
  return oscillation;
}

Rotation readRotation(const Section& body, const std::string& name, int dimensions) {
  Keys keys{"center", "speed"};
  if (dimensions == 3) keys.push_back("axis");
  const Section s = body.section("rotation", fmt::format("the rotation of [[body]] '{}'", name), keys);
  Rotation rotation;
  rotation.center = s.vector("center", dimensions, "m");
  rotation.speed = s.number("speed", Bound::Any, "rad/s");
  if (dimensions == 2) return rotation;
  rotation.axis = s.vector("axis", dimensions, "any unit");
  if (const double length = norm(rotation.axis); length == 0 || !std::isfinite(length))
    throw s.error("axis", fmt::format("expected a direction, found a vector of length {}", length));
  return rotation;
}

void readVelocity(const Section& s, int dimensions, Body& body) {
  const Formulas velocity = s.formulas("velocity", dimensions, "m/s");
  body.velocity = velocity.number;
  body.velocityExpression = velocity.text;
  if (body.kind != BodyKind::Wall) return;
  for (const std::string& text : velocity.text)
    if (!text.empty())
      throw s.error("velocity",
                    fmt::format("only a body of type \"fluid\" can have expressions; expected an array "
                                "of {} finite numbers [m/s], found \"{}\"",
                                dimensions, text));
}

Body readBody(const toml::table& table, const std::string& name, int dimensions,
              const std::vector<Material>& materials) {
  Keys keys{"name", "type", "material", "shape", "where", "velocity", "oscillation", "rotation"};
  const auto shapeWord = table["shape"].value_or(std::string_view{});
  const bool box = shapeWord == "box", sphere = shapeWord == "sphere", cylinder = shapeWord == "cylinder";
  const bool known = box || sphere || cylinder;
  // Only the keys of the shape at hand, so that a radius given to a box is an error; all while it is unclear.
  if (box || !known) keys.insert(keys.end(), {"min", "max"});
  if (sphere || !known) keys.insert(keys.end(), {"center"});
  if (cylinder || !known) keys.insert(keys.end(), {"start", "end"});
  if (!box) keys.insert(keys.end(), {"radius", "inner_radius"});
  const Section s(table, fmt::format("[[body]] '{}'{}", name, known ? fmt::format(" ({})", shapeWord) : ""), keys);

  Body body;
  body.name = name;
  body.kind = s.choice<BodyKind>("type");
  body.shape.kind = s.choice<ShapeKind>("shape");
  body.where = s.expression("where", dimensions);
  readVelocity(s, dimensions, body);
  if (s.has("oscillation")) {
    if (body.kind != BodyKind::Wall) throw s.error("oscillation", "only a body of type \"wall\" can have one");
    body.oscillation = readOscillation(s, name, dimensions);
  }
  if (s.has("rotation")) {
    if (body.kind != BodyKind::Wall) throw s.error("rotation", "only a body of type \"wall\" can have one");
    body.rotation = readRotation(s, name, dimensions);
  }
  switch (body.shape.kind) {
    case ShapeKind::Box:
      readBox(s, dimensions, body.shape);
      break;
    case ShapeKind::Sphere:
      body.shape.center = s.vector("center", dimensions, "m");
      readRadii(s, body.shape);
      break;
    case ShapeKind::Cylinder:
      body.shape.start = s.vector("start", dimensions, "m");
      body.shape.end = s.vector("end", dimensions, "m");
      if (body.shape.start == body.shape.end) throw s.error("end", "expected a point other than start");
      readRadii(s, body.shape);
      break;
  }

  const std::string material = s.string("material");
  const auto found = std::ranges::find(materials, material, &Material::name);
  if (found == materials.end()) {
    Keys names;
    for (const Material& m : materials) names.push_back(m.name);
    throw s.error("material", fmt::format("unknown material '{}'{}", material, suggestion(material, names)));
  }
  body.material = static_cast<int>(found - materials.begin());
  return body;
}

std::vector<Body> readBodies(const Section& top, int dimensions, const std::vector<Material>& materials) {
  std::vector<Body> bodies;
  for (const toml::table* table : top.tables("body"))
    bodies.push_back(readBody(*table, (*table)["name"].value_or(std::string{}), dimensions, materials));
  if (bodies.size() > maxBodies)
    throw top.error("body", fmt::format("expected at most {}, found {}", maxBodies, bodies.size()));
  if (std::ranges::none_of(bodies, [](const Body& b) { return b.kind == BodyKind::Fluid; }))
    throw top.error("body", "no fluid: expected at least one [[body]] with type = \"fluid\"");
  return bodies;
}

/// The search needs three cells along a periodic axis: with fewer, a particle would meet a neighbour twice.
void requirePeriodicLength(const Section& top, const Case& c) {
  constexpr int cells = 3;
  const double edge = c.searchEdge();
  const std::string_view edgeText = c.method.kind == MethodKind::Isph ? "2 h" : "max(h_v, 2 h_p)";
  for (int k = 0; k < c.dimensions; ++k) {
    const double length = c.domain.max[k] - c.domain.min[k];
    if (!c.domain.periodic[static_cast<std::size_t>(k)] || std::floor(length / edge) >= cells) continue;
    const Section s = top.section("domain", "[domain]", {"min", "max", "periodic"});
    throw s.error(
        "periodic",
        fmt::format("the domain is {} long along {}; a periodic axis must hold {} search cells of edge "
                    "{} = {}: expected at least {}",
                    lengthText(length), "xyz"[k], cells, edgeText, lengthText(edge), lengthText(cells * edge)));
  }
}

}  // namespace

Case readCase(const std::filesystem::path& path, std::span<const std::string> overrides) {
  const toml::table document = readDocument(path, overrides);
  const Section top(document, "the case file", topLevelKeys);
  Case c;
  c.title = top.string("title", "");
  c.dimensions = top.integer("dimensions", 2);
  if (c.dimensions > 3) throw top.error("dimensions", fmt::format("expected 2 or 3, found {}", c.dimensions));
  c.resolution = top.number("resolution", Bound::Positive, "", 1.0);
  c.spacing = top.number("spacing", Bound::Positive, "m") / c.resolution;
  c.domain = readDomain(top, c.dimensions);
  c.gravity =
      top.section("gravity", "[gravity]", {"acceleration"}).vector("acceleration", c.dimensions, "m/s2", Vec<3>{});
  c.method = readMethod(top);
  c.materials = readMaterials(top, c.method.kind);
  c.bodies = readBodies(top, c.dimensions, c.materials);
  applyWidth(top, c);
  c.time = readTime(top, c.resolution);
  c.solver = readSolver(top, c.method.kind);
  c.output = readOutput(top, c.method.kind);
  requirePeriodicLength(top, c);
  return c;
}

}  // namespace treacle
