#pragma once

#include "treacle/io/files/rows.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/rigid_body.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace treacle {

/// Appends where the rigid bodies of a case are, and how they move, to a new `rigid_bodies.csv`; numbers read back
/// to the same bits. Errors: those of RowFile.
class RigidWriter {
 public:
  /// Replaces what the target holds.
  RigidWriter(RowTarget to, const Case& c);

  /// `step` and `time` [s] after the step; `bodies`: per body of the case.
  void append(std::int64_t step, double time, const std::vector<RigidBody>& bodies);

 private:
  int dimensions_;
  Rows rows_;
};

}  // namespace treacle
