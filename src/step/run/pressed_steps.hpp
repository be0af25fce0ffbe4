#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

/// Warns of equal steps that are long for the pressure while fluid flows: what keeps particles in their places
/// then holds back fluid that shears (docs/accurate.md). Automatic steps are as short as they have to be.
class PressedSteps {
 public:
  /// After each step. `way`: StepMethod::pressedWay(); `fastest`: the speed of the fastest particle [m/s].
  void look(const Case&, double way, double fastest, std::vector<std::string>& warnings);

 private:
  int count_ = 0;  // of such steps
  bool warned_ = false;
};

}  // namespace treacle
