#pragma once

#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/frame.hpp"
#include "treacle/io/tables/history.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/case/names.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace treacle {

/// Differences between two runs a and b, of which b is the reference: relative ones are relative to it.

enum class ComparedField { Position, Velocity, Pressure, NumberDensity, NearestDistance };
inline constexpr std::size_t comparedFieldCount = 5;

namespace names {
inline constexpr Named<ComparedField> comparedField[comparedFieldCount] = {
    {"position", ComparedField::Position},
    {"velocity", ComparedField::Velocity},
    {"pressure", ComparedField::Pressure},
    {"number_density", ComparedField::NumberDensity},
    {"nearest_distance", ComparedField::NearestDistance}};
}
template <>
inline constexpr std::span<const Named<ComparedField>> namesOf<ComparedField>{names::comparedField};

/// Of a field over the particles of a frame, in the unit of the field; vectors by their Euclidean norm. Not a
/// number where either run has a value that is not finite.
struct FieldDifference {
  double maximum = 0;
  double rms = 0;       // root of the mean square
  double relative = 0;  // ||a-b||_2 / ||b||_2; of positions: rms / longest side of the fluid
};

struct FrameDifference {
  double time = 0;                     // [s], of the reference
  std::size_t frameA = 0, frameB = 0;  // numbers in their runs
  /// By ComparedField; empty where one of the frames does not hold the field.
  std::array<std::optional<FieldDifference>, comparedFieldCount> fields;

  const std::optional<FieldDifference>& operator[](ComparedField field) const {
    return fields[static_cast<std::size_t>(field)];
  }
};

/// Over the rows of both histories that have the same time.
struct HistoryDifference {
  std::size_t rows = 0;  // in both; the rest is zero if there are none
  double meanIterationsA = 0, meanIterationsB = 0;
  int earlyIterations = 0;                        // largest difference within the first ten rows
  double time = 0;                                // [s] of the last row, to which the following belong
  double frontX = 0, top = 0, kineticEnergy = 0;  // |a-b| / |b|
};

struct RunDifference {
  std::vector<FrameDifference> frames;   // in the order of time
  std::vector<double> onlyInA, onlyInB;  // times of the frames without a partner [s]
  HistoryDifference history;
};

/// Particles are matched by id, whatever their order. Differences of positions are to the nearest periodic image
/// in the reference's domain. Errors: InputError if dimensions or particles differ or a frame has no ids.
FrameDifference compareFrames(const Frame& a, const Frame& b, const Case& reference);

HistoryDifference compareHistories(std::span<const HistoryRow> a, std::span<const HistoryRow> b);

/// Fluid particles of all frames that have the same time in both runs, and the histories. Times are the same up to
/// 1e-9 of the end. Errors: InputError if a file is missing or damaged, if particles do not match, or if no frames
/// have the same time; the message begins with the path.
RunDifference compareRuns(const RunDirectory& a, const RunDirectory& b);

/// Where runs differ by more than is allowed.
struct Excess {
  std::size_t index = 0;  // into RunDifference::frames
  ComparedField field = ComparedField::Position;
};

/// In the first frame in which the relative difference of any of the fields exceeds the bound or is not a number,
/// the field that differs most. Errors: InputError if a frame does not hold one of the fields.
std::optional<Excess> firstExcess(const RunDifference& difference, std::span<const ComparedField> fields,
                                  double bound);

/// Writes the differences of the frames as CSV. Errors: RunError.
void writeFrameDifferences(const std::filesystem::path& path, std::span<const FrameDifference> frames);

}  // namespace treacle
