#include "treacle/io/shapes/shape_files.hpp"

#include "files/checksum.hpp"
#include "files/text_file.hpp"
#include "mesh_format.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/frames/particle_csv.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/model/case/case_error.hpp"

#include <fmt/format.h>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace treacle {
namespace {

namespace fs = std::filesystem;

std::string extensionOf(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

std::string contentOf(const fs::path& path) {
  if (std::error_code error; !fs::is_regular_file(path, error))
    throw InputError(
        fmt::format("{}: {}", path.string(), fs::exists(path, error) ? "is not a file" : "no such file"));
  std::string content = readTextFile(path);
  if (content.empty()) throw InputError(fmt::format("{}: the file is empty", path.string()));
  return content;
}

Triangles trianglesOf(const fs::path& path, std::string_view content) {
  const std::string extension = extensionOf(path);
  if (extension == ".stl") return readStl(path.string(), content);
  if (extension == ".obj") return readObj(path.string(), content);
  if (extension == ".ply") return readPly(path.string(), content);
  throw InputError(fmt::format("{}: expected a mesh, .stl, .obj or .ply, found '{}'", path.string(), extension));
}

GivenParticles particlesOf(const fs::path& path, int dimensions) {
  const std::string extension = extensionOf(path);
  Frame frame;
  if (extension == ".csv")
    frame = readParticleCsv(path, dimensions);
  else if (extension == ".vtp" || extension == ".pvtp")
    frame = readFrame(path);
  else
    throw InputError(
        fmt::format("{}: expected particles, .vtp, .pvtp or .csv, found '{}'", path.string(), extension));
  if (frame.position.empty()) throw InputError(fmt::format("{}: holds no particles", path.string()));
  if (frame.dimensions != dimensions)
    throw InputError(fmt::format("{}: holds particles in {} dimensions, the case has {}", path.string(),
                                 frame.dimensions, dimensions));
  const auto requireFinite = [&](const std::vector<Vec<3>>& vectors, std::string_view what) {
    for (std::size_t k = 0; k < vectors.size(); ++k)
      if (const Vec<3>& x = vectors[k]; !std::isfinite(x[0] + x[1] + x[2]))
        throw InputError(fmt::format("{}: the {} of particle {} is ({}, {}, {}); expected finite numbers",
                                     path.string(), what, k + 1, x[0], x[1], x[2]));
  };
  requireFinite(frame.position, "position");
  requireFinite(frame.velocity, "velocity");
  for (std::size_t k = 0; k < frame.temperature.size(); ++k)
    if (const double t = frame.temperature[k]; !(t > 0) || !std::isfinite(t))
      throw InputError(fmt::format("{}: the temperature of particle {} is {} K; expected more than 0",
                                   path.string(), k + 1, t));
  return {std::move(frame.position), std::move(frame.velocity), std::move(frame.temperature)};
}

std::string checksumText(std::string_view content) {
  Checksum checksum;
  checksum.add(content.data(), content.size());
  return fmt::format("{:016x}", checksum.value());
}

/// Where a case of a run was moved its files may lie beside it: the checksum tells whether they are those.
fs::path foundPath(const ShapeFile& file, const fs::path& folder) {
  const fs::path path = file.path;
  std::error_code error;
  if (file.checksum.empty() || fs::exists(path, error)) return path;
  const fs::path beside = fs::absolute(folder / path.filename(), error);
  return !error && fs::exists(beside, error) ? beside : path;
}

ShapeFile readFile(const ShapeFile& given, ShapeKind kind, int dimensions, const fs::path& folder) {
  const fs::path path = foundPath(given, folder);
  ShapeFile file;
  file.path = path.string();
  const std::string content = contentOf(path);
  file.checksum = checksumText(content);
  if (!given.checksum.empty() && given.checksum != file.checksum)
    throw InputError(
        fmt::format("{}: is not the file that the case was made with: expected the checksum {}, found {}; "
                    "leave out the key checksum to take it nevertheless",
                    file.path, given.checksum, file.checksum));
  if (kind == ShapeKind::Mesh)
    file.mesh.value = std::make_shared<const Mesh>(trianglesOf(path, content));
  else
    file.particles.value = std::make_shared<const GivenParticles>(particlesOf(path, dimensions));
  return file;
}

}  // namespace

Triangles readTriangles(const fs::path& path) { return trianglesOf(path, contentOf(path)); }

void readShapeFiles(Case& c, const fs::path& folder) {
  std::map<std::tuple<ShapeKind, std::string, std::string>, ShapeFile> known;
  for (Body& body : c.bodies) {
    Shape& s = body.shape;
    const bool mesh = s.kind == ShapeKind::Mesh;
    if (!mesh && s.kind != ShapeKind::Particles) continue;
    if (mesh ? s.file.mesh.value != nullptr : s.file.particles.value != nullptr) continue;
    const auto [entry, isNew] = known.try_emplace({s.kind, s.file.path, s.file.checksum});
    try {
      if (isNew) entry->second = readFile(s.file, s.kind, c.dimensions, folder);
    } catch (const InputError& error) {
      throw CaseError({"body", body.name, "file"}, error.what());
    }
    s.file = entry->second;
  }
}

}  // namespace treacle
