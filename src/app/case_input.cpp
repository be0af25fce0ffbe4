#include "case_input.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/checks.hpp"

#include <fmt/format.h>

namespace treacle {

void setEndTime(Case& c, std::optional<double> end) {
  if (!end) return;
  c.time.end = *end;
  try {
    requireValid(c);
  } catch (const CaseError& error) {  // all but the end was sound before
    throw InputError(fmt::format("--end-time: {}", error.text()));
  }
}

}  // namespace treacle
