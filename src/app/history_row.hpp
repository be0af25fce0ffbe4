#pragma once

#include "treacle/io/tables/history.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/step/run/simulation.hpp"

namespace treacle {

/// What the history says of a step of the case.
HistoryRow historyRow(const Case& c, const StepReport& report);

}  // namespace treacle
