#pragma once

#include "treacle/io/frames/frame.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// Frames in pieces: several files of writeVtp with a part of the particles each, and VTK's index of them (.pvtp,
/// XML PPolyData) beside them.

/// Writes the index of these pieces, one or more file names without a folder, once all of them are there: what it
/// says of arrays is what they say. Errors: RunError if a piece is missing, damaged or, as VTK expects arrays in
/// all of them, without particles; if pieces are of different times or hold different arrays; or if the index
/// cannot be written; no part of it is then left.
void writePvtp(const std::filesystem::path& path, const std::vector<std::string>& pieces);

/// Reads an index of writePvtp with all of its pieces, whose particles follow each other. Errors: InputError for
/// an index that is missing, foreign or truncated, and for pieces that are missing or damaged, are named twice or
/// do not belong together.
Frame readPvtp(const std::filesystem::path& path);

/// Reads a frame, in pieces (.pvtp) or not. Errors: those of readPvtp or readVtp.
Frame readFrame(const std::filesystem::path& path);

}  // namespace treacle
