#pragma once

#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

/// What a case is not likely to mean: units other than SI, and places, times and names at which nothing is.
void warnLikelyMistakes(const Case& c, std::vector<std::string>& warnings);

}  // namespace treacle
