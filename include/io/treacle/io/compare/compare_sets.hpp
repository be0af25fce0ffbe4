#pragma once

#include "treacle/io/compare/compare.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// Differences between two sets of particles of which nobody knows which are the same, nor whether they are as
/// many: a and b, the reference.

/// One number of either set, in SI units; empty where it has no meaning or a set does not hold the field.
struct SetMeasure {
  std::string name;  // with its axis: max_x
  std::string unit;  // empty: none
  std::optional<double> a, b;
  std::optional<double> difference;
  std::optional<double> relative;  // lengths: to the longest side of b; velocities: to the rms speed of b
};

struct SetDifference {
  std::vector<SetMeasure> measures;
  /// Positions: the distances from the particles of either set to the nearest one of the other; the larger rms of
  /// both ways, the largest distance (Hausdorff's). Other fields: a's particles against those of b that are
  /// nearest to them, relative to the rms of b.
  FrameDifference nearest;
};

/// All particles count the same, whatever their mass. Distances are to the nearest periodic image in the domain of
/// the reference; extents and centres are of its open axes only. The longest side includes its spacing.
/// Errors: InputError if dimensions differ, a set is empty or a position is not finite.
SetDifference compareSets(const Frame& a, const Frame& b, const Case& reference);

/// Writes the measures as CSV, an empty cell where there is none. Errors: RunError.
void writeSetMeasures(const std::filesystem::path& path, std::span<const SetMeasure> measures);

}  // namespace treacle
