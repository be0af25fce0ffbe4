#pragma once

#include "treacle/core/macros.hpp"

#include <cstdint>

namespace treacle {

/// Thin sheets divide the particles beside them. Each particle has a word with two bits for each sheet of the
/// case: the side of the sheet that the particle is on, or neither if the sheet is not beside it. A particle that
/// belongs to a sheet stands on one side and has the bits of the other one: the fluid there meets it behind the
/// sheet.
namespace sides {

enum Side : std::uint32_t { None = 0, Front = 1, Back = 2 };

/// Sheets of a case that the bits of a word are for.
inline constexpr int mostSheets = 13;
inline constexpr std::uint32_t ofSheet = 1u << 31;  // of a thin sheet, and which
inline constexpr std::uint32_t shown = 1u << 30;    // of the layer that pictures show as the sheet
inline constexpr int sheetShift = 26;
inline constexpr std::uint32_t fronts = 0x01555555;  // the lower bits of all sheets

TREACLE_HD constexpr std::uint32_t of(std::uint32_t word, int sheet) { return word >> (2 * sheet) & 3; }
TREACLE_HD constexpr std::uint32_t with(std::uint32_t word, int sheet, std::uint32_t side) {
  return (word & ~(3u << (2 * sheet))) | side << (2 * sheet);
}
/// The word of a particle that belongs to a sheet and is met from this side of it.
TREACLE_HD constexpr std::uint32_t sheetParticle(int sheet, std::uint32_t side) {
  return ofSheet | static_cast<std::uint32_t>(sheet) << sheetShift | side << (2 * sheet);
}
TREACLE_HD constexpr int sheetOf(std::uint32_t word) { return static_cast<int>(word >> sheetShift & 15); }

/// Whether a particle may be seen by another one: particles of a sheet are seen only from beside it.
TREACLE_HD constexpr bool isMet(std::uint32_t particle, std::uint32_t from) {
  return !(particle & ofSheet) || of(from, sheetOf(particle)) != None;
}

/// Whether two particles act on each other: they are not on different sides of any sheet, and a particle of a
/// sheet is met only from its side.
TREACLE_HD constexpr bool seeEachOther(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t parted = ((a & fronts) << 1 & b) | ((b & fronts) << 1 & a);
  return (parted & (fronts << 1)) == 0 && isMet(a, b) && isMet(b, a);
}

}  // namespace sides

}  // namespace treacle
