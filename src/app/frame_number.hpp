#pragma once

#include "treacle/io/files/run_directory.hpp"

#include <cstddef>
#include <string>

namespace treacle {

/// The frame of a run that --frame names: "last", or a number. Errors: InputError, also where the run has none.
std::size_t frameNumber(const std::string& option, const RunDirectory& run);

/// Errors: InputError where the run has no frame.
void requireFrames(const RunDirectory& run);

}  // namespace treacle
