#include "treacle/core/trace.hpp"

namespace treacle {

// Builds without CUDA have no profiler that would read the ranges; kernels/core/trace.cu takes this file's place
// in those with it.
TraceRange::TraceRange(const char*) {}
TraceRange::~TraceRange() = default;

}  // namespace treacle
