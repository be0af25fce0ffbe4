#pragma once

#include <string_view>

namespace treacle {

/// The vector instructions that loops over particles run on this machine: "AVX-512", "AVX2", "SSE4.2", "NEON" or
/// "none".
std::string_view vectorInstructions();

}  // namespace treacle
