#pragma once

#include "commands.hpp"

#include <filesystem>

namespace treacle {

/// Whether compare takes the path for a CSV file, not for the directory of a run.
bool isParticleFile(const std::filesystem::path& path);

/// The command compare where A, B or both are CSV files of particles. Whether they agree within the bound.
/// Errors: InputError, RunError.
bool compareFiles(const CompareOptions& options);

}  // namespace treacle
