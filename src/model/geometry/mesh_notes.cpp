#include "mesh_notes.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/geometry/mesh.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

/// A place of the mesh, in the case.
std::string placeText(const Body& body, const Vec<3>& x) {
  return positionText(similarityOf<3>(body.shape).point(x), 3);
}

/// Whether a mesh need not have an inside.
bool isSheet(const Shape& s) { return s.fill == FillKind::Sheet || s.isThinSheet(); }

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

void requireContent(const Body& body) {
  const Shape& s = body.shape;
  if (s.kind == ShapeKind::Particles && !s.file.particles.value)
    throw InputError(fmt::format("body '{}': its particles have not been read from {}", body.name, s.file.path));
  const auto requireField = [&](bool wanted, std::size_t count, std::string_view key, std::string_view what) {
    if (wanted && count == 0)
      throw InputError(fmt::format("body '{}': {} = true: {} holds no {}", body.name, key, s.file.path, what));
  };
  if (s.kind == ShapeKind::Particles) {
    requireField(body.fileVelocities, s.file.particles.value->velocity.size(), "file_velocities", "velocities");
    requireField(body.fileTemperatures, s.file.particles.value->temperature.size(), "file_temperatures",
                 "temperatures");
  }
  if (s.kind != ShapeKind::Mesh) return;
  if (!s.file.mesh.value)
    throw InputError(fmt::format("body '{}': its mesh has not been read from {}", body.name, s.file.path));
  const MeshFacts& facts = s.file.mesh.value->facts();
  if (facts.triangles == 0)
    throw InputError(fmt::format("body '{}': no face of {} has an area", body.name, s.file.path));
  // What an open mesh encloses is not quite known, but mostly its sign.
  const Vec<3> size = facts.max - facts.min;
  const double least = facts.closed() ? 0 : -0.1 * size[0] * size[1] * size[2];
  const double volume = s.flip ? -facts.volume : facts.volume;
  if (isSheet(s) || volume >= least) return;
  const double scale = similarityOf<3>(s).scale();
  throw InputError(fmt::format(
      "body '{}': {} is inside-out: its faces, whose corners must go round counter-clockwise seen from outside, "
      "enclose {:.4g} m3; {}",
      body.name, s.file.path, volume * scale * scale * scale,
      s.flip ? "leave out flip" : "turn them round with flip = true"));
}

void noteMesh(const Case& c, const Body& body, std::vector<std::string>& notes) {
  const Shape& s = body.shape;
  if (s.kind != ShapeKind::Mesh) return;
  for (const Body& earlier : c.bodies) {
    if (&earlier == &body) break;
    if (earlier.shape.file.mesh.value == s.file.mesh.value) return;
  }
  const MeshFacts& facts = s.file.mesh.value->facts();
  const auto note = [&](const std::string& text) {
    notes.push_back(fmt::format("body '{}': {}: {}", body.name, s.file.path, text));
  };
  if (facts.openEdges > 0 && !isSheet(s))
    note(
        fmt::format("the mesh is open at {}, the first at {}; what is inside is decided by winding numbers, which "
                    "close small holes smoothly",
                    counted(facts.openEdges, "edge"), placeText(body, facts.opening)));
  if (facts.turnedEdges > 0 && !isSheet(s))
    note(fmt::format(
        "faces on both sides of {} do not agree on where outside is, the first at {}; turn them in the "
        "program that made the file",
        counted(facts.turnedEdges, "edge"), placeText(body, facts.turned)));
  if (facts.flat > 0)
    note(fmt::format("{} without an area left out, the first is face {}", counted(facts.flat, "face"),
                     facts.firstFlat));
  if (facts.twice > 0)
    note(fmt::format("{} left out that an earlier one is the same as, the first is face {}",
                     counted(facts.twice, "face"), facts.firstTwice));
  if (const MeshCrossings crossings = s.file.mesh.value->findCrossings(); crossings.pairs > 0)
    note(fmt::format(
        "{} of faces cut each other, the first are the faces {} and {} near {}; what more than one "
        "piece of the mesh encloses counts once",
        counted(crossings.pairs, "pair"), crossings.first, crossings.second, placeText(body, crossings.place)));
}

}  // namespace treacle
