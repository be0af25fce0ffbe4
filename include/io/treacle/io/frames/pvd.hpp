#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// ParaView's index of the frames of one group of particles (.pvd).
struct PvdEntry {
  double time = 0;   // [s]
  std::string file;  // relative to the index
};

/// Errors: RunError; an older index then stays as it was.
void writePvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries);

/// Reads an index of writePvd. Errors: InputError for a missing or foreign file.
std::vector<PvdEntry> readPvd(const std::filesystem::path& path);

}  // namespace treacle
