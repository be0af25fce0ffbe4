#pragma once

#include "treacle/core/error.hpp"

#include <string>
#include <vector>

namespace treacle {

/// Where a value stands in a case: the keys of tables and the names of materials and bodies on the way to its own
/// key, as in {"body", "left wall", "oscillation", "period"}.
using CasePath = std::vector<std::string>;

/// A case that cannot be run. The message is that for a case made in code: the path, as --set takes it, and the
/// text, `body."left wall".oscillation.period: expected a positive number [s], found 0`. Who read the case from a
/// file says where that is instead.
class CaseError : public InputError {
 public:
  CaseError(CasePath path, std::string text);

  const CasePath& path() const { return path_; }
  /// What was expected and what was found.
  const std::string& text() const { return text_; }

 private:
  CasePath path_;
  std::string text_;
};

}  // namespace treacle
