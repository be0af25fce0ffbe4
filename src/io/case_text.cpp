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

void writeVelocity(Text& text, const Body& b, int dimensions) {
  std::vector<std::string> entries;
  for (int k = 0; k < dimensions; ++k) {
    const std::string& expression = b.velocityExpression[static_cast<std::size_t>(k)];
    entries.push_back(expression.empty() ? fmt::format("{}", b.velocity[k]) : tomlString(expression));
  }
  line(text, "velocity = [{}]", fmt::join(entries, ", "));
}

void writeRotation(Text& text, const Rotation& r, int dimensions) {
  const std::string axis = dimensions == 3 ? ", axis = " + array(r.axis, 3) : "";
  line(text, "rotation = {{ center = {}, speed = {}{} }}", array(r.center, dimensions), r.speed, axis);
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
    if (c.method.kind == MethodKind::Isph) continue;
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
    if (!b.where.empty()) line(text, "where = {}", tomlString(b.where));
    writeVelocity(text, b, c.dimensions);
    if (const Oscillation& o = b.oscillation; o.period > 0)
      line(text, "oscillation = {{ amplitude = {}, period = {}, phase = {} }}", array(o.amplitude, c.dimensions),
           o.period, o.phase);
    if (b.rotation) writeRotation(text, *b.rotation, c.dimensions);
  }
}

void writeTime(Text& text, const TimeSettings& time) {
  line(text, "\n[time]");
  line(text, "step = {}", time.step);
  line(text, "end = {}", time.end);
  line(text, "courant = {}", time.courant);
}

void writeMethod(Text& text, const MethodSettings& method) {
  line(text, "\n[method]");
  line(text, "name = \"{}\"", nameOf(method.kind));
  if (method.kind == MethodKind::MphI) {
    line(text, "pressure_radius = {}", method.pressureRadius);
    line(text, "viscosity_radius = {}", method.viscosityRadius);
    return;
  }
  const IsphSettings& isph = method.isph;
  line(text, "kernel = \"{}\"", nameOf(isph.kernel));
  line(text, "smoothing_ratio = {}", isph.smoothingRatio);
  line(text, "alpha = {}", isph.alpha);
  line(text, "walls = \"{}\"", nameOf(isph.walls));
  line(text, "viscosity = \"{}\"", nameOf(isph.viscosity));
  line(text, "shifting = {}", isph.shifting);
  line(text, "negative_pressure = {}", isph.negativePressure);
}

void writeMphSolver(Text& text, const SolverSettings& solver) {
  line(text, "operator = \"{}\"", nameOf(solver.operatorKind));
  line(text, "neighbours = \"{}\"", nameOf(solver.neighbours));
  line(text, "deflation = {}", solver.deflation);
  line(text, "\n[solver.multigrid]");
  line(text, "finest_sweeps = {}", solver.multigrid.finestSweeps);
  line(text, "middle_sweeps = {}", solver.multigrid.middleSweeps);
  line(text, "coarsest_sweeps = {}", solver.multigrid.coarsestSweeps);
  line(text, "particle_diagonal = \"{}\"", nameOf(solver.multigrid.particleDiagonal));
  line(text, "coarse_operators = \"{}\"", nameOf(solver.multigrid.coarseOperators));
  line(text, "\n[solver.projected]");
  line(text, "pressure_degree = {}", solver.projected.pressureDegree);
  line(text, "grid_degree = {}", solver.projected.gridDegree);
  line(text, "velocity_degree = {}", solver.projected.velocityDegree);
  line(text, "iteration_bound = {}", solver.projected.iterationBound);
}

void writeIsphSolver(Text& text, const SolverSettings& solver) {
  line(text, "\n[solver.cells]");
  line(text, "levels = {}", solver.cells.levels);
  line(text, "sweeps = {}", solver.cells.sweeps);
  line(text, "\n[solver.hats]");
  line(text, "grid_degree = {}", solver.hats.gridDegree);
  line(text, "iteration_bound = {}", solver.hats.iterationBound);
}

void writeSolver(Text& text, const SolverSettings& solver, MethodKind method) {
  line(text, "\n[solver]");
  line(text, "krylov = \"{}\"", nameOf(solver.krylov));
  line(text, "preconditioner = \"{}\"", nameOf(solver.preconditioner));
  line(text, "precision = \"{}\"", nameOf(solver.precision));
  line(text, "first_guess = \"{}\"", nameOf(solver.firstGuess));
  line(text, "tolerance = {}", solver.tolerance);
  line(text, "max_iterations = {}", solver.maxIterations);
  method == MethodKind::Isph ? writeIsphSolver(text, solver) : writeMphSolver(text, solver);
}

void writeOutput(Text& text, const OutputSettings& output, MethodKind method) {
  std::vector<std::string> fields;
  for (const OutputFieldName& f : outputFieldNames)
    if (output.fields.*(f.flag)) fields.push_back(tomlString(f.name));
  line(text, "\n[output]");
  line(text, "interval = {}", output.interval);
  line(text, "checkpoint_interval = {}", output.checkpointInterval);
  line(text, "fields = [{}]", fmt::join(fields, ", "));
  line(text, "format = \"vtp\"");
  line(text, "precision = \"{}\"", nameOf(output.precision));
  if (method == MethodKind::MphI) line(text, "balance = {}", output.balance);
}

}  // namespace

std::string caseText(const Case& c) {
  Text text;
  line(text, "# SI units. Base file, resolution and command-line settings are applied; every key is explicit.");
  writeWorld(text, c);
  writeTime(text, c.time);
  writeMethod(text, c.method);
  writeSolver(text, c.solver, c.method.kind);
  writeOutput(text, c.output, c.method.kind);
  return fmt::to_string(text);
}

}  // namespace treacle
