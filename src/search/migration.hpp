#pragma once

#include "treacle/search/fluid_fields.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

// Particles that come and go, and the room for them.

/// Room for so many own fluid particles and ghosts; the first own ones and all walls stay.
template <int D>
void resizeFluid(Particles<D>& p, std::uint32_t fluid, std::uint32_t ghosts) {
  const std::uint32_t kept = std::min(fluid, p.fluidCount), walls = p.wallCount(), modes = p.modeCount();
  forEachSharedFieldOf(
      [&]<class T>(Buffer<T>& field) {
        Buffer<T> next(std::size_t{fluid} + ghosts + walls);
        std::copy_n(field.begin(), kept, next.begin());
        std::copy_n(field.begin() + p.wallBegin(), walls, next.begin() + fluid + ghosts);
        field = std::move(next);
      },
      p);
  const auto resizeRows = [&]<class T>(Buffer<T>& field, std::uint32_t rows) {
    Buffer<T> next(std::size_t{rows} * fluid);
    for (std::size_t r = 0; r < rows; ++r)
      std::copy_n(field.begin() + r * p.fluidCount, kept, next.begin() + r * fluid);
    field = std::move(next);
  };
  if (fluid != p.fluidCount) {
    forEachFluidFieldOf([&](auto& field) { resizeRows(field, 1); }, p);
    if (modes > 0) resizeRows(p.modes.vectors, modes);
  }
  p.fluidCount = fluid;
  p.ghostCount = ghosts;
  p.count = fluid + ghosts + walls;
}

/// All fields of these own fluid particles, field after field.
template <int D>
std::vector<std::byte> packed(Particles<D>& p, std::span<const std::uint32_t> indices) {
  std::vector<std::byte> bytes;
  forEachFieldOfFluid(p, [&]<class T>(const T* field) {
    const std::size_t at = bytes.size();
    bytes.resize(at + indices.size() * sizeof(T));
    for (std::size_t k = 0; k < indices.size(); ++k)
      std::memcpy(bytes.data() + at + k * sizeof(T), field + indices[k], sizeof(T));
  });
  return bytes;
}

/// The same into the places [begin, begin + count).
template <int D>
void unpack(std::span<const std::byte> bytes, Particles<D>& p, std::uint32_t begin, std::uint32_t count) {
  std::size_t at = 0;
  forEachFieldOfFluid(p, [&]<class T>(T* field) {
    if (count > 0) std::memcpy(field + begin, bytes.data() + at, count * sizeof(T));
    at += count * sizeof(T);
  });
}

/// Bytes of all fields of one.
template <int D>
std::size_t packedBytes(Particles<D>& p) {
  std::size_t sum = 0;
  forEachFieldOfFluid(p, [&]<class T>(const T*) { sum += sizeof(T); });
  return sum;
}

/// Keeps these own fluid particles alone, in ascending order, with room for so many others behind them. Both at
/// once: particles without fluid would not know how many modes they had.
template <int D>
void keepFluid(Particles<D>& p, std::span<const std::uint32_t> kept, std::uint32_t others) {
  forEachFieldOfFluid(p, [&]<class T>(T* field) {
    for (std::size_t k = 0; k < kept.size(); ++k) field[k] = field[kept[k]];
  });
  resizeFluid(p, static_cast<std::uint32_t>(kept.size()) + others, 0);
}

}  // namespace treacle
