#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// The candidate that somebody who typed `word` probably meant: one that contains it (`viscosity`) or the nearest
/// by edit distance; empty when none is near.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// "; did you mean 'x'?" or, when none is near, "; expected 'a', 'b' or 'c'".
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace treacle
