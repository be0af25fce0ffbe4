#pragma once

#include "mph_files.hpp"
#include "treacle/io/import_case.hpp"

#include <array>
#include <string>
#include <string_view>

namespace treacle {

/// The case of what was read; `name`: of the case file to be, without its ending. Errors: those of importCase.
ImportedCase convertedCase(const MphParameters& parameters, const MphGeometry& geometry, const std::string& name);

/// The bodies of a case whose settings and materials are there. `materialOf`: of each type; -1: none.
void addBodies(ImportedCase& imported, const MphParameters& parameters, const MphGeometry& geometry,
               const std::array<int, mphTypes>& materialOf, const std::string& name);

/// "fluid0", "fluid1", "wall2", "wall3".
std::string nameOfMphType(int type);

/// A case file with the keys that an imported case has; `origin`: a line about where it comes from.
std::string importedText(const Case& c, std::string_view origin);

}  // namespace treacle
