#pragma once

#include "treacle/model/particles/any_particles.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace treacle {

/// A copy of the state after a step, and what is to be written of it.
struct Snapshot {
  AnyParticles particles{2};
  std::shared_ptr<const void> pinned;  // what lets a device copy to them directly; gone before they are
  std::int64_t step = 0;
  double time = 0;     // [s]
  int iterations = 0;  // of the step; 0 for the state at the start
  bool frame = false, checkpoint = false;
  bool whole = false;  // not while it is being filled

  // Where it is of a process's own particles, to be a piece of a frame.
  std::uint32_t ownWalls = 0;  // the first of its walls; the others are those near it
  std::size_t number = 0;      // of the frame
};

}  // namespace treacle
