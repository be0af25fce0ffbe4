#pragma once

#include "treacle/core/communicator.hpp"

#include <functional>
#include <string>

namespace treacle {

/// Does at every process what may fail at some of them, each for itself. Errors: where one fails all throw its
/// InputError or RunError, that of the first in the order of ranks; memory that is exhausted counts as a RunError.
void together(const Communicator& processes, const std::function<void()>& body);

/// Errors: InputError, at all processes, if some of them have another case than the first one, or are another
/// program.
void requireSame(const Communicator& processes, const std::string& theCase);

}  // namespace treacle
