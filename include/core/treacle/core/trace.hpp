#pragma once

namespace treacle {

/// A named range on the time line of a profiler (NVTX); costs nothing without one.
class TraceRange {
 public:
  explicit TraceRange(const char* name);
  TraceRange(const TraceRange&) = delete;
  TraceRange& operator=(const TraceRange&) = delete;
  ~TraceRange();
};

}  // namespace treacle
