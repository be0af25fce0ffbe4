#include "import_parts.hpp"
#include "toml_string.hpp"
#include "treacle/model/names.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

std::string vectorText(const Vec<3>& x, int dimensions) {
  std::string text;
  for (int k = 0; k < dimensions; ++k) text += fmt::format("{}{}", k > 0 ? ", " : "", x[k]);
  return '[' + text + ']';
}

std::string periodicText(const Case& c) {
  std::string text;
  for (std::size_t k = 0; k < static_cast<std::size_t>(c.dimensions); ++k)
    text += fmt::format("{}{}", k > 0 ? ", " : "", c.domain.periodic[k]);
  return '[' + text + ']';
}

std::string materialText(const Material& m) {
  return fmt::format(
      "\n[[material]]\nname = {}\ndensity = {}\ndynamic_viscosity = {}\nbulk_viscosity = {}\nbulk_modulus = {}\n",
      tomlString(m.name), m.density, m.dynamicViscosity, m.bulkViscosity, m.bulkModulus);
}

std::string bodyText(const Case& c, const Body& b) {
  const int d = c.dimensions;
  std::string text =
      fmt::format("\n[[body]]\nname = {}\ntype = {}\nmaterial = {}\nshape = {}\n", tomlString(b.name),
                  tomlString(nameOf(b.kind)), tomlString(c.materials[static_cast<std::size_t>(b.material)].name),
                  tomlString(nameOf(b.shape.kind)));
  if (b.shape.kind == ShapeKind::Box)
    text += fmt::format("min = {}\nmax = {}\n", vectorText(b.shape.min, d), vectorText(b.shape.max, d));
  else
    text += fmt::format("file = {}\n", tomlString(b.shape.file.path));
  if (b.fileVelocities) text += "file_velocities = true\n";
  if (b.velocity != Vec<3>{}) text += fmt::format("velocity = {}\n", vectorText(b.velocity, d));
  if (b.rotation)
    text +=
        fmt::format("rotation = {{ center = {}, {}speed = {} }}\n", vectorText(b.rotation->center, d),
                    d == 3 ? fmt::format("axis = {}, ", vectorText(b.rotation->axis, d)) : "", b.rotation->speed);
  return text;
}

}  // namespace

std::string importedText(const Case& c, std::string_view origin) {
  std::string text = fmt::format("# {}. SI units.\ntitle = {}\ndimensions = {}\nspacing = {}\n", origin,
                                 tomlString(c.title), c.dimensions, c.spacing);
  text += fmt::format("\n[domain]\nmin = {}\nmax = {}\nperiodic = {}\n", vectorText(c.domain.min, c.dimensions),
                      vectorText(c.domain.max, c.dimensions), periodicText(c));
  text += fmt::format("\n[gravity]\nacceleration = {}\n", vectorText(c.gravity, c.dimensions));
  for (const Material& m : c.materials) text += materialText(m);
  for (const Body& b : c.bodies) text += bodyText(c, b);
  text += fmt::format("\n[time]\nstep = {}\nend = {}\n", c.time.step, c.time.end);
  text += fmt::format("\n[method]\nscheme = {}\npressure_radius = {}\nviscosity_radius = {}\n",
                      tomlString(nameOf(c.method.scheme)), c.method.pressureRadius, c.method.viscosityRadius);
  return text + fmt::format("\n[output]\ninterval = {}\ncheckpoint_interval = {}\n", c.output.interval,
                            c.output.checkpointInterval);
}

}  // namespace treacle
