#pragma once

#include "treacle/io/compare/compare.hpp"
#include "treacle/io/compare/compare_sets.hpp"

#include <span>
#include <string>

namespace treacle {

/// A row per frame, to stdout.
void printFrames(std::span<const FrameDifference> frames);

/// A row per measure, to stdout.
void printMeasures(std::span<const SetMeasure> measures);

/// Their names, for the verdict.
std::string listOf(std::span<const ComparedField> fields);

}  // namespace treacle
