#include "treacle/core/trace.hpp"

#include <nvtx3/nvToolsExt.h>

namespace treacle {

TraceRange::TraceRange(const char* name) { nvtxRangePushA(name); }
TraceRange::~TraceRange() { nvtxRangePop(); }

}  // namespace treacle
