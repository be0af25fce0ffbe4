#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/case.hpp"

namespace treacle {

/// Errors: InputError for a case that processes cannot share so far, with what it would have to be.
void requireShareable(const Case& c, BackendKind backend);

}  // namespace treacle
