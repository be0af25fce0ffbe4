#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/vec.hpp"

#include <cstdint>

namespace treacle {

/// The only owner of per-particle fields. Fluid particles come first, [0, fluidCount), then wall particles,
/// [fluidCount, count); inside both groups the search keeps them sorted by cell. `id` names a particle for
/// good: 0 … count-1 in the order of creation.
template <int D, class Backend = Cpu>
struct Particles {
  std::uint32_t fluidCount = 0;
  std::uint32_t count = 0;

  Buffer<Vec<D>, Backend> position;        // x [m]
  Buffer<Vec<D>, Backend> velocity;        // u [m/s]
  Buffer<double, Backend> pressure;        // Psi [Pa]
  Buffer<double, Backend> numberDensity;   // n [-]
  Buffer<std::uint8_t, Backend> material;  // index into Case::materials
  Buffer<std::uint32_t, Backend> id;

  std::uint32_t wallCount() const { return count - fluidCount; }

  void resize(std::uint32_t fluid, std::uint32_t wall) {
    fluidCount = fluid;
    count = fluid + wall;
    forEachField([this](auto& field) { field.resize(count); });
  }

  /// Calls f with every field: what permutes, saves or compares particles cannot forget one.
  template <class F>
  void forEachField(F&& f) {
    f(position), f(velocity), f(pressure), f(numberDensity), f(material), f(id);
  }
};

}  // namespace treacle
