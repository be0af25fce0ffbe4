#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/step/walls/near_blocks.hpp"

#include <algorithm>
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
///
/// Where processes share the simulation each comes with a part of the walls, and keeps those of them that are far;
/// those that are near are held by all processes. All members but those that return numbers are then collective.
template <int D>
class DistantWalls {
 public:
  /// Takes them out of the particles, of a state at `time` [s]. `processes`: those that have parts of fluid and
  /// walls, null where all of it is here. Errors: std::bad_alloc.
  DistantWalls(const Case& c, const CellGrid<D>& cells, Particles<D>& particles, double time,
               const Communicator* processes = nullptr);

  /// How many the simulation does without at present, at all processes.
  std::uint32_t count() const { return countOfAll_; }
  std::uint32_t surfaceCount() const { return hasSurfaces_ ? countOfAll_ : 0; }

  /// A step of dt [s] was made, in which no fluid went farther than `fluidWay` [m].
  void addStep(double dt, double fluidWay);
  /// Whether something may have come near, or does so within another dt [s] in which no fluid goes farther than
  /// `fluidWay` [m].
  bool isDue(double dt, double fluidWay) const {
    return storedSome_ && way_ + std::max(fluidWay, dt * wallSpeed_) > near_.margin();
  }

  /// Whether other walls than before are to be held where these blocks are near.
  bool differs(const NearBlocks<D>& near) const;
  /// Those that are to be held then; `walls`: those that are held, and no fluid. Errors: std::bad_alloc.
  Particles<D> held(const NearBlocks<D>& near, const Particles<D>& walls) const;
  /// They are.
  void accept(NearBlocks<D> near);

  /// Makes them the last wall particles of `all`; of several processes at the first, that of others is not
  /// touched. Errors: std::bad_alloc.
  void copyTo(Particles<D>& all) const;
  /// Those of this process's part. Errors: std::bad_alloc.
  Particles<D> ofPart() const;

  std::size_t bytes() const {
    return position_.bytes() + material_.bytes() + body_.bytes() + id_.bytes() + surface_.bytes();
  }

 private:
  void copyTo(Particles<D>& particles, std::uint32_t first, std::span<const std::uint32_t> which) const;
  Particles<D> chosen(std::span<const std::uint32_t> which) const;
  Buffer<std::uint32_t> missing() const;
  void store(const Particles<D>& particles, std::span<const std::uint32_t> which);
  void holdThoseOfAll(Particles<D>& particles);
  void countMissing();

  const Communicator* processes_;
  NearBlocks<D> near_;
  std::vector<std::uint8_t> stored_;  // per block: its walls at rest are among these, of whichever process
  bool storedSome_ = false, hasSurfaces_ = false;
  // Of all that were far at the start, and in this process's part.
  Buffer<Vec<D>> position_;  // [m]
  Buffer<std::uint8_t> material_, body_;
  Buffer<std::uint32_t> id_;
  Buffer<WallSurface<D>> surface_;  // empty where none is known
  std::uint32_t countOfAll_ = 0;
  double way_ = 0;        // of the fastest since the choice [m]
  double wallSpeed_ = 0;  // that no wall exceeds [m/s]
};

extern template class DistantWalls<2>;
extern template class DistantWalls<3>;

}  // namespace treacle
