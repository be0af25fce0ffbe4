#pragma once

#include "treacle/io/history.hpp"
#include "treacle/model/case.hpp"
#include "treacle/step/simulation.hpp"

namespace treacle {

/// What the history says of a step of the case.
HistoryRow historyRow(const Case& c, const StepReport& report);

}  // namespace treacle
