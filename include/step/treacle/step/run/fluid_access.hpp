#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/materials/material_state.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// The fields of the fluid that callers may look at between steps.
enum class FluidField {
  Position,
  Velocity,
  Pressure,
  NumberDensity,
  ShearRate,
  Temperature,
  ViscosityFactor,
  Material,
  Body,
  Id,
  State  // and those behind it: the states of materials, in the order of Case::stateNames
};
inline FluidField fieldOfState(std::size_t k) {
  return static_cast<FluidField>(static_cast<std::size_t>(FluidField::State) + k);
}

/// Where one of them lies: `count` entries of `components` numbers each, of the type of Particles. What makes a
/// step may move it, give up the memory, and put the particles into another order.
struct FieldMemory {
  const void* data = nullptr;  // null: the fluid does not have the field
  std::size_t count = 0, bytes = 0;
  int components = 1;
  BackendKind where = BackendKind::Cpu;
};

/// What the fluid is to have from now on: numbers per particle in the present order of Particles, whichever is
/// empty stays as it is.
struct GivenFluid {
  std::span<const double> position;           // as many numbers per particle as there are dimensions [m]
  std::span<const double> velocity;           // likewise [m/s]
  std::span<const double> temperature;        // [K]
  std::span<const double> viscosityFactor{};  // [-]; where there are none, the fluid has some then
  std::array<std::span<const double>, maxStates> states{};  // in the order of Case::stateNames
  BackendKind where = BackendKind::Cpu;                     // whose memory these are in
};

}  // namespace treacle
