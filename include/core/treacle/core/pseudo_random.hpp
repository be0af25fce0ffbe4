#pragma once

#include "treacle/core/macros.hpp"

#include <cstdint>

namespace treacle {

/// Uniform in (-1, 1) and exact in single precision, the same on every backend.
TREACLE_HD inline float pseudoRandom(std::uint32_t index) {
  std::uint32_t h = index * 0x9e3779b9u + 0x7f4a7c15u;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  h ^= h >> 16;
  return (static_cast<float>(h >> 9) + 0.5f) * 0x1p-22f - 1.0f;
}

}  // namespace treacle
