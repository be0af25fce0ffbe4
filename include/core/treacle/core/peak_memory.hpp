#pragma once

#include <cstdint>

namespace treacle {

/// Largest resident size of this process so far [B].
std::uint64_t peakMemory();

}  // namespace treacle
