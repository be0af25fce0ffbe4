#pragma once

#include "treacle/model/case/time_function.hpp"

#include <filesystem>
#include <string>

namespace treacle {

/// A table of time from a text file with a column of times [s], the first one, and one or more of values,
/// separated by commas, semicolons, tabs or blanks, with or without names above. `column`: the name of that of the
/// values; empty: the second one. Errors: InputError with path and line.
TimeFunction readTimeTable(const std::filesystem::path& path, const std::string& column);

}  // namespace treacle
