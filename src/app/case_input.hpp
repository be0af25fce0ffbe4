#pragma once

#include "commands.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_error.hpp"

#include <optional>

namespace treacle {

/// Sets when a run ends, in place of what the case says [s]. Errors: InputError that begins with --end-time.
void setEndTime(Case& c, std::optional<double> end);

/// Calls make(), which makes what a case describes. Its errors get the places that they have in the case file.
template <class Make>
auto withPlaces(const CaseOptions& input, Make&& make) {
  try {
    return make();
  } catch (const CaseError& error) {
    throw errorInFile(error, input.file, input.overrides);
  }
}

}  // namespace treacle
