#include "treacle/io/import_case.hpp"

#include "import_parts.hpp"
#include "text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case_keys.hpp"
#include "treacle/model/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace treacle {
namespace {

namespace fs = std::filesystem;

std::string parameterRow(const MphParameters& p, const std::string& row) {
  const auto line = p.lines.find(row);
  return line == p.lines.end() ? fmt::format("{}: {}", p.path, row)
                               : fmt::format("{}:{}: {}", p.path, line->second, row);
}

std::array<bool, mphTypes> usedTypes(const MphGeometry& g) {
  std::array<bool, mphTypes> used{};
  for (const MphCuboid& cuboid : g.cuboids) used[static_cast<std::size_t>(cuboid.type)] = true;
  for (const MphParticle& particle : g.particles) used[static_cast<std::size_t>(particle.type)] = true;
  return used;
}

/// Whether all particles are one layer in z, as those of the program's cases in two dimensions.
bool isFlat(const MphGeometry& g) {
  const double slack = 1e-6 * g.spacing;
  const auto height = [](const MphCuboid& cuboid) { return (cuboid.lower[2] + cuboid.upper[2]) / 2; };
  return std::ranges::all_of(g.cuboids,
                             [&](const MphCuboid& cuboid) {
                               return cuboid.upper[2] - cuboid.lower[2] < 1.5 * g.spacing &&
                                      std::abs(height(cuboid) - height(g.cuboids.front())) < slack;
                             }) &&
         std::ranges::all_of(g.particles, [&](const MphParticle& particle) {
           return std::abs(particle.position[2] - g.particles.front().position[2]) < slack;
         });
}

/// The program's domain is periodic; here a periodic axis has three search cells at least.
void setDomain(ImportedCase& imported, const MphGeometry& g) {
  Case& c = imported.value;
  for (int k = 0; k < c.dimensions; ++k) {
    c.domain.min[k] = g.lower[k], c.domain.max[k] = g.upper[k];
    const bool periodic = std::floor((g.upper[k] - g.lower[k]) / c.searchEdge()) >= 3;
    c.domain.periodic[static_cast<std::size_t>(k)] = periodic;
    if (!periodic)
      imported.warnings.push_back(fmt::format(
          "{}: the domain is {} long along {}, less than three search cells of {}, and so open there and "
          "not periodic",
          g.path, g.upper[k] - g.lower[k], "xyz"[k], c.searchEdge()));
  }
}

void setTime(ImportedCase& imported, const MphParameters& p, const MphGeometry& g) {
  Case& c = imported.value;
  if (!(p.end > g.time))
    throw InputError(fmt::format("{}: expected a time after that of the particles in {}, {}, found {}",
                                 parameterRow(p, "EndTime"), g.path, g.time, p.end));
  c.time.step = p.step;
  c.time.end = p.end - g.time;
  c.output.interval = p.pictureInterval;
  c.output.checkpointInterval = p.profileInterval;
  if (g.time > 0)
    imported.warnings.push_back(
        fmt::format("{}: the particles are those of t = {}, which is time 0 of the case; pressures begin at 0",
                    g.path, g.time));
}

/// What forces of the surfaces there are in the program is a model of its own.
void noteSurfaceTension(ImportedCase& imported, const MphParameters& p, const std::array<bool, mphTypes>& used) {
  for (std::size_t type = 0; type < mphTypes; ++type) {
    if (!used[type]) continue;
    const MphType& t = p.types[type];
    if (t.surfaceTension != 0)
      imported.warnings.push_back(
          fmt::format("{} of type {} is {} and left out, as is RadiusRatioA: the forces between particles that it "
                      "stands for are "
                      "another model than surface_tension of a material",
                      parameterRow(p, "SurfaceTension"), type, t.surfaceTension));
    if (t.interactionRatio != MphType{}.interactionRatio)
      imported.warnings.push_back(
          fmt::format("{} is not 1 throughout and left out: it belongs to another model of surface tension",
                      parameterRow(p, fmt::format("InteractionRatio(Type{})", type))));
  }
}

std::array<int, mphTypes> addMaterials(ImportedCase& imported, const MphParameters& p,
                                       const std::array<bool, mphTypes>& used) {
  Case& c = imported.value;
  std::array<int, mphTypes> materialOf{-1, -1, -1, -1};
  for (std::size_t type = 0; type < mphTypes; ++type) {
    if (!used[type]) continue;
    const MphType& t = p.types[type];
    if (!(t.density > 0))
      throw InputError(
          fmt::format("{}: expected a positive number for type {}, of which there are particles, found {}",
                      parameterRow(p, "Density"), type, t.density));
    Material m;
    m.name = nameOfMphType(static_cast<int>(type));
    m.density = t.density;
    m.dynamicViscosity = t.shearViscosity;
    m.bulkViscosity = t.bulkViscosity;
    m.bulkModulus = t.bulkModulus;
    materialOf[type] = static_cast<int>(c.materials.size());
    c.materials.push_back(m);
  }
  return materialOf;
}

MphGeometry readGeometry(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".grid") return readMphParticles(path.string(), readTextFile(path));
  if (extension == ".boid") return readMphCuboids(path.string(), readTextFile(path));
  throw InputError(fmt::format("{}: expected a file with particles, .grid, or cuboids, .boid, found '{}'",
                               path.string(), extension));
}

}  // namespace

std::string nameOfMphType(int type) { return fmt::format("{}{}", type < firstMphWall ? "fluid" : "wall", type); }

ImportedCase convertedCase(const MphParameters& p, const MphGeometry& g, const std::string& name) {
  ImportedCase imported;
  imported.warnings = p.warnings;
  Case& c = imported.value;
  c.title = name;
  c.dimensions = isFlat(g) ? 2 : 3;
  c.spacing = g.spacing;
  c.method = defaultMethod(SchemeKind::Published);
  c.method.pressureRadius = p.pressureRatio;
  c.method.viscosityRadius = p.viscosityRatio;
  setDomain(imported, g);
  c.gravity = p.gravity;
  if (c.dimensions == 2 && c.gravity[2] != 0)
    imported.warnings.push_back(fmt::format("{} along z is {} and left out: the particles are one layer",
                                            parameterRow(p, "Gravity"), std::exchange(c.gravity[2], 0)));
  setTime(imported, p, g);
  const auto used = usedTypes(g);
  noteSurfaceTension(imported, p, used);
  addBodies(imported, p, g, addMaterials(imported, p, used), name);
  try {
    requireValid(c);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, {}: cannot be a case: {}", p.path, g.path, error.what()));
  }
  const auto nameOfFile = [](const std::string& path) { return fs::path(path).filename().string(); };
  imported.text = importedText(
      c, fmt::format("The case of {:?} and {:?}, by treacle import", nameOfFile(p.path), nameOfFile(g.path)));
  return imported;
}

ImportedCase importCase(const fs::path& parameters, const fs::path& geometry, const fs::path& output) {
  const MphGeometry g = readGeometry(geometry);
  return convertedCase(readMphParameters(parameters.string(), readTextFile(parameters)), g,
                       output.stem().string());
}

}  // namespace treacle
