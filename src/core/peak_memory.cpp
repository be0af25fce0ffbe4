#include "treacle/core/peak_memory.hpp"

#include <sys/resource.h>

namespace treacle {

std::uint64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) << 10;
}

}  // namespace treacle
