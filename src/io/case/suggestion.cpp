#include "suggestion.hpp"

#include "treacle/model/case/names.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <utility>

namespace treacle {
namespace {

/// Insertions, deletions and replacements that turn a into b.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = std::exchange(row[j], std::min({replaced, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  constexpr std::size_t shortestFragment = 4;  // "in" is part of many words
  std::string_view best;
  std::size_t bestDistance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (std::string_view candidate : candidates) {
    if (word.size() >= shortestFragment && candidate.find(word) != candidate.npos) return candidate;
    if (const std::size_t d = editDistance(word, candidate); d < bestDistance) bestDistance = d, best = candidate;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest(word, candidates);
  if (near.empty()) return "; expected " + listOf(candidates);
  // A bare `viscosity` is the commonest slip: say which of the two and in which unit.
  const char* unit = near == "dynamic_viscosity" ? " [Pa s]" : "";
  return fmt::format("; did you mean '{}'{}?", near, unit);
}

}  // namespace treacle
