#pragma once

#include "case_section.hpp"
#include "treacle/model/case.hpp"

namespace treacle {

/// Stretches domain and bodies along one axis as the table [width] says; a case without it stays as it is. Radii
/// stay what they are. `top`: the whole file. Errors: InputError.
void applyWidth(const Section& top, Case& c);

}  // namespace treacle
