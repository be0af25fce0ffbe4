#include "treacle/io/case_reader.hpp"
#include "treacle/model/names.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

using Text = fmt::memory_buffer;

template <class... Args>
void line(Text& text, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
  text.push_back('\n');
}

/// A TOML basic string.
std::string tomlString(std::string_view s) {
  std::string q = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\')
      q += '\\', q += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      q += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      q += c;
  }
  return q + '"';
}

std::string array(const Vec<3>& x, int dimensions) {
  return fmt::format("[{}]", fmt::join(x.v, x.v + dimensions, ", "));
}

void writeShape(Text& text, const Shape& s, int dimensions) {
  switch (s.kind) {
    case ShapeKind::Box:
      line(text, "min = {}", array(s.min, dimensions));
      line(text, "max = {}", array(s.max, dimensions));
      return;
    case ShapeKind::Sphere:
      line(text, "center = {}", array(s.center, dimensions));
      break;
    case ShapeKind::Cylinder:
      line(text, "start = {}", array(s.start, dimensions));
      line(text, "end = {}", array(s.end, dimensions));
      break;
  }
  line(text, "radius = {}", s.radius);
  line(text, "inner_radius = {}", s.innerRadius);
}

void writeWorld(Text& text, const Case& c) {
  line(text, "title = {}", tomlString(c.title));
  line(text, "dimensions = {}", c.dimensions);
  line(text, "spacing = {}", c.spacing);
  line(text, "resolution = 1");
  line(text, "\n[domain]");
  line(text, "min = {}", array(c.domain.min, c.dimensions));
  line(text, "max = {}", array(c.domain.max, c.dimensions));
  line(text, "periodic = [{}]",
       fmt::join(c.domain.periodic.begin(), c.domain.periodic.begin() + c.dimensions, ", "));
  line(text, "\n[gravity]");
  line(text, "acceleration = {}", array(c.gravity, c.dimensions));
  for (const Material& m : c.materials) {
    line(text, "\n[[material]]");
    line(text, "name = {}", tomlString(m.name));
    line(text, "density = {}", m.density);
    line(text, "dynamic_viscosity = {}", m.dynamicViscosity);
    line(text, "bulk_viscosity = {}", m.bulkViscosity);
    line(text, "bulk_modulus = {}", m.bulkModulus);
  }
  for (const Body& b : c.bodies) {
    line(text, "\n[[body]]");
    line(text, "name = {}", tomlString(b.name));
    line(text, "type = \"{}\"", nameOf(b.kind));
    line(text, "material = {}", tomlString(c.materials[static_cast<std::size_t>(b.material)].name));
    line(text, "shape = \"{}\"", nameOf(b.shape.kind));
    writeShape(text, b.shape, c.dimensions);
    line(text, "velocity = {}", array(b.velocity, c.dimensions));
  }
}

void writeSettings(Text& text, const Case& c) {
  line(text, "\n[time]");
  line(text, "step = {}", c.time.step);
  line(text, "end = {}", c.time.end);
  line(text, "\n[method]");
  line(text, "name = {}", tomlString(c.method.name));
  line(text, "pressure_radius = {}", c.method.pressureRadius);
  line(text, "viscosity_radius = {}", c.method.viscosityRadius);
  line(text, "\n[solver]");
  line(text, "krylov = \"{}\"", nameOf(c.solver.krylov));
  line(text, "preconditioner = \"{}\"", nameOf(c.solver.preconditioner));
  line(text, "operator = \"{}\"", nameOf(c.solver.operatorKind));
  line(text, "neighbours = \"{}\"", nameOf(c.solver.neighbours));
  line(text, "precision = \"{}\"", nameOf(c.solver.precision));
  line(text, "first_guess = \"{}\"", nameOf(c.solver.firstGuess));
  line(text, "tolerance = {}", c.solver.tolerance);
  line(text, "max_iterations = {}", c.solver.maxIterations);
  line(text, "\n[solver.multigrid]");
  line(text, "finest_sweeps = {}", c.solver.multigrid.finestSweeps);
  line(text, "middle_sweeps = {}", c.solver.multigrid.middleSweeps);
  line(text, "coarsest_sweeps = {}", c.solver.multigrid.coarsestSweeps);
  line(text, "particle_diagonal = \"{}\"", nameOf(c.solver.multigrid.particleDiagonal));
  line(text, "coarse_operators = \"{}\"", nameOf(c.solver.multigrid.coarseOperators));
  line(text, "\n[solver.projected]");
  line(text, "pressure_degree = {}", c.solver.projected.pressureDegree);
  line(text, "grid_degree = {}", c.solver.projected.gridDegree);
  line(text, "velocity_degree = {}", c.solver.projected.velocityDegree);
  line(text, "iteration_bound = {}", c.solver.projected.iterationBound);
}

void writeOutput(Text& text, const OutputSettings& output) {
  std::vector<std::string> fields;
  for (const OutputFieldName& f : outputFieldNames)
    if (output.fields.*(f.flag)) fields.push_back(tomlString(f.name));
  line(text, "\n[output]");
  line(text, "interval = {}", output.interval);
  line(text, "checkpoint_interval = {}", output.checkpointInterval);
  line(text, "fields = [{}]", fmt::join(fields, ", "));
  line(text, "format = \"vtp\"");
  line(text, "precision = \"{}\"", nameOf(output.precision));
}

}  // namespace

std::string caseText(const Case& c) {
  Text text;
  line(text, "# SI units. Base file, resolution and command-line settings are applied; every key is explicit.");
  writeWorld(text, c);
  writeSettings(text, c);
  writeOutput(text, c.output);
  return fmt::to_string(text);
}

}  // namespace treacle
