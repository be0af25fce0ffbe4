#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/motion/rigid_body.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// A set of bodies of a case; kernels take it by value.
struct BodySet {
  std::uint64_t bits[4]{};

  void add(std::size_t body) { bits[body / 64] |= std::uint64_t{1} << body % 64; }
  TREACLE_HD bool has(std::uint8_t body) const { return bits[body / 64] >> body % 64 & 1; }
  bool isEmpty() const { return (bits[0] | bits[1] | bits[2] | bits[3]) == 0; }
};

/// The bodies of the motion that are rigid.
inline BodySet rigidBodies(const RigidMotion& motion) {
  BodySet rigid;
  for (std::size_t b = 0; b < motion.bodies.size(); ++b)
    if (motion.bodies[b].mass > 0) rigid.add(b);
  return rigid;
}

/// What a wall particle adds, by "or", to the word of its cell: from the words of some cells together
/// mayTouch() tells whether a rigid body and another body have particles in them.
TREACLE_HD inline std::uint32_t wordOfBody(std::uint8_t body, bool isRigid) {
  const std::uint32_t others = std::uint32_t{0xff} ^ body;
  return body | others << 8 | std::uint32_t{isRigid} << 16;
}

/// Of two bodies one has a bit that the other one lacks.
TREACLE_HD inline bool mayTouch(std::uint32_t words) { return (words >> 16 & 1) && (words & words >> 8 & 0xff); }

/// Whether a rigid body may touch another body in this cell and its neighbours. `words`: per cell.
template <int D>
TREACLE_HD bool mayTouchAround(const CellGrid<D>& grid, const std::uint32_t* words, const Vec<D, int>& cell) {
  std::uint32_t all = 0;
  forEachAdjacentCell(grid, cell, [&](const Vec<D, int>& c) { all |= words[grid.linear(c)]; });
  return mayTouch(all);
}

/// Adds wall particles to the words of their cells. `words`: per cell, at first 0.
template <int D>
void addBodies(const CellGrid<D>& grid, std::span<const Vec<D>> position, std::span<const std::uint8_t> body,
               const BodySet& rigid, std::span<std::uint32_t> words) {
  for (std::size_t i = 0; i < position.size(); ++i)
    if (isFinitePosition(position[i]))
      words[grid.linear(grid.cellOf(position[i]))] |= wordOfBody(body[i], rigid.has(body[i]));
}

}  // namespace treacle
