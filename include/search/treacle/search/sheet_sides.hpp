#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/geometry/side_map.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Brings the words of particles (sides) to where the particles are now. Sheets in the order of the case, in the
/// backend's memory.
template <int D, class Backend>
void updateSides(Context<Backend>&, std::span<const PlacedSheet<D>> sheets, std::span<const Vec<D>> position,
                 std::span<std::uint32_t> side);

/// The formula: the word of a particle at x.
template <int D>
TREACLE_HD std::uint32_t updatedSide(std::span<const PlacedSheet<D>> sheets, const Vec<D>& x, std::uint32_t word) {
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const auto sheet = static_cast<int>(s);
    if ((word & sides::ofSheet) && sides::sheetOf(word) == sheet) continue;
    word = movedSide(word, sheet, sheets[s].heightAt(x));
  }
  return word;
}

}  // namespace treacle
