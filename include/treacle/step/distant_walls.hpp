#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/search/cell_owners.hpp"
#include "treacle/step/near_blocks.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The wall particles that a simulation does without, because they rest far from all that moves (NearBlocks):
/// their places, materials, bodies, ids and surfaces, in the host's memory. Velocity, pressure and number density
/// of such walls are zero. What moves comes near them in the course of time: then the simulation takes them in,
/// and leaves out again what is no longer near. Whole blocks of cells come and go, in the order that the particles
/// have here, so that all that the simulation has is in the same order as if it had all walls.
template <int D>
class DistantWalls {
 public:
  /// Takes them out of the particles, of a state at `time` [s]. `processes`: those that have parts of the fluid,
  /// null where all of it is here; then collective. Errors: std::bad_alloc.
  DistantWalls(const Case& c, const CellGrid<D>& cells, Particles<D>& particles, double time,
               const Communicator* processes = nullptr);

  /// How many the simulation does without at present.
  std::uint32_t count() const { return count_; }
  std::uint32_t surfaceCount() const { return surface_.empty() ? 0 : count_; }

  /// A step of dt [s] was made, in which no fluid went farther than `fluidWay` [m].
  void addStep(double dt, double fluidWay);
  /// Whether something may have come near.
  bool isDue() const { return position_.size() > 0 && way_ > near_.margin(); }

  /// Whether other walls than before are to be held where these blocks are near.
  bool differs(const NearBlocks<D>& near) const;
  /// Those that are to be held then; `walls`: those that are held, and no fluid. Errors: std::bad_alloc.
  Particles<D> held(const NearBlocks<D>& near, const Particles<D>& walls) const;
  /// They are.
  void accept(NearBlocks<D> near);

  /// Makes them the last wall particles of `all`.
  void copyTo(Particles<D>& all) const;
  /// Those in a process's own cells. Errors: std::bad_alloc.
  Particles<D> inOwnCells(const CellGrid<D>& cells, const CellOwners<D>& owners) const;

  std::size_t bytes() const {
    return position_.bytes() + material_.bytes() + body_.bytes() + id_.bytes() + surface_.bytes();
  }

 private:
  void copyTo(Particles<D>& particles, std::uint32_t first, std::span<const std::uint32_t> which) const;
  Buffer<std::uint32_t> missing() const;
  void store(const Particles<D>& particles, std::span<const std::uint32_t> which);

  NearBlocks<D> near_;
  std::vector<std::uint8_t> stored_;  // per block: its walls at rest are among these
  // Of all that were far at the start.
  Buffer<Vec<D>> position_;  // [m]
  Buffer<std::uint8_t> material_, body_;
  Buffer<std::uint32_t> id_;
  Buffer<WallSurface<D>> surface_;  // empty where none is known
  std::uint32_t count_ = 0;
  double way_ = 0;        // of the fastest since the choice [m]
  double wallSpeed_ = 0;  // that no wall exceeds [m/s]
};

extern template class DistantWalls<2>;
extern template class DistantWalls<3>;

}  // namespace treacle
