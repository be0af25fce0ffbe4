#pragma once

#include "treacle/model/case.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace treacle {

/// Whether the files that shapes are made of are read with a case (io/shape_files.hpp): whoever makes its
/// particles needs them, whoever only looks at a run does not, and may not have them.
enum class ShapeFiles { Read, Leave };

/// Reads a case file with everything it inherits by `base`, and checks the case as requireValid does;
/// docs/cases.md lists the keys. `overrides`: "key=value" each, as given to --set, applied in order on top of the
/// files. Errors: InputError that begins with file:line:column (or "--set ...") and says what was found and
/// expected.
Case readCase(const std::filesystem::path& path, std::span<const std::string> overrides = {},
              ShapeFiles files = ShapeFiles::Read);

/// The case as a complete TOML file: resolution applied (and therefore 1), every key explicit, files
/// by absolute paths and with their checksums. Reading it gives the same case and the same particles.
std::string caseText(const Case& c);

}  // namespace treacle
