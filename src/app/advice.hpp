#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle {

/// Prints, as comments of a case file, numbers of the fluids of a case and what follows from them for its spacing,
/// its step and its bulk constants (docs/choosing.md).
void printAdvice(const Case& c);

}  // namespace treacle
