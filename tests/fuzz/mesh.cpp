// Meshes in each of their formats, and what is done with those that are taken.

#include "treacle/model/geometry/mesh.hpp"
#include "input_file.hpp"
#include "shapes/mesh_format.hpp"
#include "treacle/model/particles/create.hpp"

#include <string>
#include <vector>

using namespace treacle;

namespace {

/// Fills a box around a mesh with some thousand points, those inside with fluid.
void fill(std::shared_ptr<const Mesh> mesh, FillKind kind) {
  Case c;
  c.dimensions = 3;
  double size = 0;
  for (int k = 0; k < 3; ++k) size = std::max(size, mesh->facts().max[k] - mesh->facts().min[k]);
  c.spacing = size / 8;
  if (!(c.spacing > 0)) return;
  for (int k = 0; k < 3; ++k) {
    const double middle = (mesh->facts().min[k] + mesh->facts().max[k]) / 2;
    c.domain.min[k] = middle - size, c.domain.max[k] = middle + size;
  }
  c.materials.emplace_back();
  Body body;
  body.name = "mesh", body.shape.kind = ShapeKind::Mesh, body.shape.fill = kind;
  body.shape.file.mesh.value = std::move(mesh);
  c.bodies = {body};
  std::vector<std::string> notes;
  createParticles(c, notes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto read : {readStl, readObj, readPly})
    fuzz::accept([&] {
      const auto mesh = std::make_shared<const Mesh>(read("mesh", fuzz::textOf(data, size)));
      static_cast<void>(mesh->findCrossings());
      if (mesh->facts().triangles > 1000 || mesh->facts().triangles == 0) return;
      for (const FillKind kind : {FillKind::Inside, FillKind::Outside, FillKind::Sheet})
        fuzz::accept([&] { fill(mesh, kind); });
    });
  return 0;
}
