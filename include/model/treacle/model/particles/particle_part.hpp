#pragma once

#include <cstdint>

namespace treacle {

/// One of so many parts of a case's particles, by ids that follow each other, of the fluid and of the walls: what
/// a process begins with where several share a simulation. By default all of them.
struct ParticlePart {
  std::uint32_t index = 0, parts = 1;

  bool isAll() const { return parts == 1; }
  /// Of `count` particles of a kind this part has [begin, end).
  std::uint32_t begin(std::uint32_t count) const { return at(count, index); }
  std::uint32_t end(std::uint32_t count) const { return at(count, index + 1); }
  std::uint32_t size(std::uint32_t count) const { return end(count) - begin(count); }

 private:
  std::uint32_t at(std::uint32_t count, std::uint32_t k) const {
    return static_cast<std::uint32_t>(std::uint64_t{count} * k / parts);
  }
};

}  // namespace treacle
