#pragma once

#include "treacle/core/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace treacle {

template <int D>
class FacetTree;

/// Triangles as a file gives them, in its unit of length. Seen from outside their corners go round
/// counter-clockwise.
struct Triangles {
  std::vector<Vec<3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> corners;  // indices of vertices
  std::vector<std::uint32_t> face;  // of each triangle: the face of the file it is of, from 1; empty: its own
};

/// What is to be known of a mesh.
struct MeshFacts {
  std::size_t triangles = 0;  // that it is made of
  double volume = 0;          // enclosed, negative where the mesh is inside-out [unit^3]
  double area = 0;            // [unit^2]
  Vec<3> min{}, max{};        // of the smallest box around it [unit]
  // Faces that were left out, and the first of them in the file, from 1.
  std::size_t flat = 0, firstFlat = 0;    // without an area
  std::size_t twice = 0, firstTwice = 0;  // that an earlier one is the same as
  // Edges at which the surface ends, or has an odd number of sheets too many; and the middle of one of them
  // [unit].
  std::size_t openEdges = 0;
  Vec<3> opening{};
  std::size_t turnedEdges = 0;  // whose two faces do not agree on which side is outside
  Vec<3> turned{};              // the middle of one of them [unit]

  /// Whether every point is clearly inside or outside.
  bool closed() const { return openEdges == 0 && turnedEdges == 0; }
};

/// Pairs of faces that cut each other but have no corner in common.
struct MeshCrossings {
  std::size_t pairs = 0;
  std::size_t first = 0, second = 0;  // faces of the file, from 1
  Vec<3> place{};                     // a corner of the first [unit]
};

/// A surface of triangles in a tree, ready for questions.
class Mesh {
 public:
  /// Leaves out faces without an area and those that are there twice. Indices must be those of vertices, and
  /// vertices finite.
  explicit Mesh(Triangles triangles);
  ~Mesh();

  const MeshFacts& facts() const { return facts_; }
  /// Takes about as long as the mesh itself.
  MeshCrossings findCrossings() const;
  const FacetTree<3>& tree() const { return *tree_; }

 private:
  MeshFacts facts_;
  std::vector<std::uint32_t> face_;  // of the file, of each facet of the tree; from 1
  std::unique_ptr<const FacetTree<3>> tree_;
};

}  // namespace treacle
