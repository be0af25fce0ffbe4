#pragma once

#include "treacle/io/frames/frame.hpp"

#include <filesystem>
#include <optional>

namespace treacle {

/// Reads particles from a table of text, such as another program writes: a line of column names, then a row per
/// particle; docs/command.md says how columns may be called. Columns of other names are passed over.
/// `dimensions`: those that the table must have; without, it has 3 if the z of any particle is not zero, else 2.
/// Errors: InputError that begins with file:line and says what was found and expected.
Frame readParticleCsv(const std::filesystem::path& path, std::optional<int> dimensions = std::nullopt);

}  // namespace treacle
