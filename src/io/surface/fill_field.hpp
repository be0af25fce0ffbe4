#pragma once

#include "case/block_key.hpp"
#include "treacle/core/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace treacle {

/// Which share of space the fluid fills, as a field on a grid: each particle is spread over 4 spacings by the
/// product of cubic B-splines, whose sum over a lattice is 1 inside and exactly flat along its sides. Where it is
/// 1/2 the fluid ends: half a spacing outside of the outermost particles of a lattice, so that what is enclosed is
/// the volume of the particles. Particles with hardly any others around, whose share is nowhere 1/2, fill a ball
/// each, of as much volume.
/// The grid has nodes everywhere at the same places, in blocks of 8 x 8 x 8. Blocks deep inside, which have
/// particles all over them and around them, are not computed, nor are those far outside.
class FillField {
 public:
  static constexpr int blockNodes = 8;  // along an axis

  /// `node`: distance of nodes in spacings, 1/4 to 1. Particles whose position is not finite or absurdly far away
  /// are left out.
  FillField(const std::vector<Vec<3>>& position, double spacing, double node);

  std::size_t leftOut() const { return leftOut_; }  // particles
  const std::vector<Block>& computed() const { return computed_; }
  const std::vector<Block>& inside() const { return inside_; }

  /// 1/2 less the share at the nodes of a block, the last axis running fastest: negative inside the fluid. Returns
  /// whether it holds anything.
  bool values(const Block& block, float* out) const;
  static constexpr float outside = 0.5F, within = -0.5F;

  /// The coordinates of a place between nodes [m], which is counted in nodes from that of block (0, 0, 0).
  Vec<3> place(const Vec<3>& nodes) const;

  /// For what fills the place, counted in nodes, by its share; some particle at least within a spacing of the
  /// fluid.
  void forEachAround(const Vec<3>& nodes,
                     const std::function<void(std::uint32_t particle, double weight)>& f) const;

 private:
  struct Point {
    Vec<3, float> nodes;  // from the first one of its block
    float ball = 0;       // radius of the ball that it fills at least [spacings]
    std::uint32_t particle;
  };

  void sort(const std::vector<Vec<3>>& position);
  void choose();
  void findBalls(const std::vector<char>& deep);
  std::size_t find(const Block& block) const;  // into keys_; their number where it has no particles
  bool isFull(std::size_t block) const;

  double spacing_, node_, reach_;  // [m], [spacings], of a particle [nodes]
  std::size_t leftOut_ = 0;
  Block origin_{};                    // block (0, 0, 0), in blocks from the origin of space
  std::vector<Point> points_;         // by block
  std::vector<std::uint64_t> keys_;   // of the blocks with particles, ascending
  std::vector<std::uint32_t> begin_;  // of their points; one more
  std::vector<Block> computed_, inside_;
};

}  // namespace treacle
