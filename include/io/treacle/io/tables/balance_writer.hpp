#pragma once

#include "treacle/io/files/rows.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/state/balance.hpp"

#include <cstdint>
#include <filesystem>

namespace treacle {

/// Appends the balances of time steps to a new `balance.csv`; numbers read back to the same bits. Errors: those of
/// RowFile.
class BalanceWriter {
 public:
  /// Replaces what the target holds. The case names the walls and the dimension.
  BalanceWriter(RowTarget to, const Case& c);

  /// `step` and `time` [s] after the step.
  void append(std::int64_t step, double time, const Balance& balance);

 private:
  int dimensions_;
  bool repels_;
  bool shifts_;
  bool hasSurface_, rises_, hasStates_;
  Rows rows_;
};

}  // namespace treacle
