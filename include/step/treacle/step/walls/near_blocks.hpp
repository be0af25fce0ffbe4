#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Which parts of the domain are near something that moves, fluid or walls. The search cells are put together in
/// blocks, two along each axis, three at the end of an odd number of them; a block is near where there is
/// something that moves in it or at most two blocks away. Walls at rest in other blocks take part in no sum before
/// something has moved by margin(), and nothing that moves gets into their cells.
template <int D>
class NearBlocks {
 public:
  /// No block is near. `cells`: those of the case's search.
  NearBlocks(const Case& c, const CellGrid<D>& cells);

  /// At these places there is something that moves [m].
  void addMoving(std::span<const Vec<D>> position);
  /// Those wall particles that move are where they are.
  void addMovingWalls(const Particles<D>& particles);
  /// And what is so to any of these processes, at all of them, once all that moves is added. Collective.
  void unite(const Communicator& processes) { processes.anyOf(steps_); }
  /// All fluid, and those wall particles that move.
  void add(const Particles<D>& particles);

  /// Whether particle i never moves: neither it nor the wall that it belongs to, nor does the domain, which brings
  /// back what lies at a periodic end.
  bool rests(const Particles<D>& particles, std::uint32_t i) const;
  /// Whether wall particle i is at rest and not near.
  bool isFar(const Particles<D>& particles, std::uint32_t i) const {
    return rests(particles, i) && !isNear(blockOf(particles.position[i]));
  }
  /// The wall particles that may move, ascending.
  Buffer<std::uint32_t> movingWalls(const Particles<D>& particles) const;

  std::size_t count() const { return steps_.size(); }
  std::size_t blockOf(const Vec<D>& x) const { return blocks_.linear(blockAt(x)); }
  bool isNear(std::size_t block) const { return steps_[block] != 0; }

  /// How far the fastest may go until what is near is to be found anew [m].
  double margin() const;

 private:
  Vec<D, int> blockAt(const Vec<D>& x) const {
    Vec<D, int> at = cells_.cellOf(x);
    for (int k = 0; k < D; ++k) at[k] = std::min(at[k] / cellsOfBlock, blocks_.count[k] - 1);
    return at;
  }
  void spread(const Vec<D, int>& block, std::uint8_t steps);

  static constexpr int cellsOfBlock = 2;
  static constexpr std::uint8_t blocksBetween = 2;  // that lie between something that moves and what is far

  CellGrid<D> cells_, blocks_;  // of the second only numbers and ends are meant
  std::vector<bool> bodyRests_;
  std::vector<std::uint8_t> steps_;  // per block: from it to what is far; 0: it is far itself
};

/// A copy of the particles without the walls that are far from all that moves, in their order.
template <int D>
Particles<D> nearParticles(const NearBlocks<D>& near, const Particles<D>& all);

extern template class NearBlocks<2>;
extern template class NearBlocks<3>;
extern template Particles<2> nearParticles<2>(const NearBlocks<2>&, const Particles<2>&);
extern template Particles<3> nearParticles<3>(const NearBlocks<3>&, const Particles<3>&);

}  // namespace treacle
