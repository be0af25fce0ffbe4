#pragma once

#include "treacle/io/frames/arrangement.hpp"
#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/case.hpp"

#include <optional>
#include <string>

namespace treacle {

/// Says when fluid that touches nothing rests: sums over neighbours reach across a gap to the wall below.
class HangingWatch {
 public:
  explicit HangingWatch(const Case& c) : case_(c) {}

  /// A warning about two frames in a row, once in a run.
  std::optional<std::string> look(const Frame& fluid, const Frame& walls, const Arrangement& arrangement);

 private:
  const Case& case_;
  std::optional<double> before_;  // time of the last frame, if the fluid touched nothing in it [s]
  bool warned_ = false;
};

}  // namespace treacle
