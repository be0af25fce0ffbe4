#pragma once

#include <cstdint>

namespace treacle {

/// One of so many parts of a case's fluid, by numbers of particles that follow each other: what a process begins
/// with where several share a simulation. By default all of it.
struct FluidPart {
  std::uint32_t index = 0, parts = 1;

  /// Of `fluid` particles this part has [begin, end).
  std::uint32_t begin(std::uint32_t fluid) const { return at(fluid, index); }
  std::uint32_t end(std::uint32_t fluid) const { return at(fluid, index + 1); }
  std::uint32_t size(std::uint32_t fluid) const { return end(fluid) - begin(fluid); }

 private:
  std::uint32_t at(std::uint32_t fluid, std::uint32_t k) const {
    return static_cast<std::uint32_t>(std::uint64_t{fluid} * k / parts);
  }
};

}  // namespace treacle
