#pragma once

#include "treacle/model/case.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// Particles of a body, as a file beside the case file.
struct ParticleTable {
  std::string name;     // of the file, without its folder
  std::string content;  // CSV
};

/// A case of the program of the authors of [K23] as one of this program (docs/import.md).
struct ImportedCase {
  Case value;        // with the places of its particles, so that they can be made
  std::string text;  // of the case file
  std::vector<ParticleTable> tables;
  std::vector<std::string> warnings;  // what has no counterpart and is left out
};

/// Reads parameters (.data), and particles (.grid) or cuboids (.boid). `output`: the case file to be, after which
/// the tables are named. Nothing is written. Errors: InputError that begins with the path, and with the line where
/// there is one, and says what was found and expected.
ImportedCase importCase(const std::filesystem::path& parameters, const std::filesystem::path& geometry,
                        const std::filesystem::path& output);

}  // namespace treacle
