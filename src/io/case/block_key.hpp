#pragma once

#include <array>
#include <cstdint>

namespace treacle {

/// A block of a grid, by its number along each axis. Sorted by their keys, blocks are in the order of these
/// numbers.
using Block = std::array<int, 3>;

namespace blockKey {
inline constexpr int bits = 21;  // per axis
inline constexpr int half = 1 << (bits - 1);
}  // namespace blockKey

/// Blocks to either side of block (0, 0, 0), along an axis, of which two have keys after one has become the
/// origin, and their neighbours, too.
inline constexpr int mostBlocks = blockKey::half / 2 - 2;

inline std::uint64_t keyOf(const Block& block) {
  std::uint64_t key = 0;
  for (const int x : block) key = key << blockKey::bits | static_cast<std::uint64_t>(x + blockKey::half);
  return key;
}

inline Block blockOf(std::uint64_t key) {
  constexpr std::uint64_t mask = (1 << blockKey::bits) - 1;
  Block block{};
  for (auto x = block.rbegin(); x != block.rend(); ++x, key >>= blockKey::bits)
    *x = static_cast<int>(key & mask) - blockKey::half;
  return block;
}

/// The block itself and the 26 around it, in the order of their keys.
template <class F>
void forEachNeighbour(const Block& b, F f) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) f(Block{b[0] + x, b[1] + y, b[2] + z});
}

}  // namespace treacle
