// A module of its own, which the program loads when it makes a surface: OpenVDB takes 38 ms to load. Its headers
// are slow to compile, and nobody else includes them.
#include "volume_mesh.hpp"

#include <omp.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>

namespace treacle {
namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
static_assert(Leaf::DIM == 8);

openvdb::Coord firstNode(const std::array<int, 3>& block) { return {8 * block[0], 8 * block[1], 8 * block[2]}; }

openvdb::FloatGrid::Ptr gridOf(const BlockedField& field) {
  std::vector<std::unique_ptr<Leaf>> leaves(field.blocks.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    auto leaf = std::make_unique<Leaf>(firstNode(field.blocks[k]), field.outside, true);
    if (field.values(k, leaf->buffer().data())) leaves[k] = std::move(leaf);
  }
  const auto grid = openvdb::FloatGrid::create(field.outside);
  for (const auto& block : field.inside) grid->tree().addTile(1, firstNode(block), field.within, false);
  for (auto& leaf : leaves)
    if (leaf) grid->tree().addLeaf(leaf.release());
  return grid;
}

TriangleMesh meshOf(const BlockedField& field) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(omp_get_max_threads()));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*gridOf(field), points, triangles, quads, 0);

  TriangleMesh mesh;
  mesh.points.reserve(points.size());
  for (const auto& p : points) mesh.points.push_back({p.x(), p.y(), p.z()});
  mesh.triangles.reserve(triangles.size() + 2 * quads.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.triangles.push_back({a, b, c}); };
  for (const auto& t : triangles) add(t[0], t[1], t[2]);
  const auto distance2 = [&](std::uint32_t a, std::uint32_t b) { return norm2(mesh.points[a] - mesh.points[b]); };
  for (const auto& q : quads) {
    const int first = distance2(q[0], q[2]) <= distance2(q[1], q[3]) ? 0 : 1;  // the shorter diagonal
    add(q[first], q[first + 1], q[first + 2]);
    add(q[first], q[first + 2], q[(first + 3) % 4]);
  }
  return mesh;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] void treacleVolumeMesh(const BlockedField& field, TriangleMesh& mesh) {
  mesh = meshOf(field);
}

}  // namespace treacle
