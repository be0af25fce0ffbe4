#pragma once

#include "flow_state.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/error.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/step/method/move_particles.hpp"
#include "treacle/step/run/fluid_access.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace treacle {

template <int D, class Backend>
FieldMemory fieldMemory(const Particles<D, Backend>& p, FluidField field) {
  constexpr BackendKind where = std::is_same_v<Backend, Cuda> ? BackendKind::Cuda : BackendKind::Cpu;
  const auto of = [&](const auto& buffer, int components, bool has = true) {
    const std::size_t bytes = p.fluidCount * sizeof(*buffer.data());
    return has ? FieldMemory{buffer.data(), p.fluidCount, bytes, components, where} : FieldMemory{.where = where};
  };
  switch (field) {
    case FluidField::Position:
      return of(p.position, D);
    case FluidField::Velocity:
      return of(p.velocity, D);
    case FluidField::Pressure:
      return of(p.pressure, 1);
    case FluidField::NumberDensity:
      return of(p.numberDensity, 1);
    case FluidField::ShearRate:
      return of(p.shearRate, 1, p.has.shearRates);
    case FluidField::Temperature:
      return of(p.temperature, 1, p.has.temperatures);
    case FluidField::ViscosityFactor:
      return of(p.viscosityFactor, 1, p.has.viscosityFactors);
    case FluidField::Material:
      return of(p.material, 1);
    case FluidField::Body:
      return of(p.body, 1);
    case FluidField::Id:
      return of(p.id, 1);
    case FluidField::State:
      break;
  }
  const auto state = static_cast<std::size_t>(field) - static_cast<std::size_t>(FluidField::State);
  return state < p.has.states ? of(p.states[state], 1) : FieldMemory{.where = where};
}

/// To the host; `host` has room for it.
inline void copyField(const Context<Cpu>&, const FieldMemory& field, void* host) {
  if (field.bytes > 0) std::memcpy(host, field.data, field.bytes);
}
inline void copyField(const Context<Cuda>& context, const FieldMemory& field, void* host) {
  if (field.bytes > 0) copyBytesToHost(context, field.data, host, field.bytes);
}

/// What was given, of one kind, in the backend's memory.
template <class T, class Backend>
Buffer<T, Backend> broughtHere(Context<Backend>& context, std::span<const double> given, BackendKind where,
                               std::uint32_t count, const char* what) {
  constexpr std::size_t components = sizeof(T) / sizeof(double);
  if (given.size() != count * components)
    throw InputError(fmt::format("{}: expected {} numbers for each of {} particles, found {} numbers", what,
                                 components, count, given.size()));
  const std::span<const T> values(reinterpret_cast<const T*>(given.data()), count);
  Buffer<T, Backend> here;
  here.resize(context, count);
  if constexpr (std::is_same_v<Backend, Cuda>) {
    if (where == BackendKind::Cuda)
      copyValues(context, values, here.data());
    else
      copyFromHost(context, values, here.data());
  } else {
    if (where == BackendKind::Cuda)
      throw InputError(
          fmt::format("{}: in the memory of a GPU, but the CPU computes; expected memory of the host", what));
    copyValues(context, values, here.data());
  }
  return here;
}

/// Errors: InputError for a particle outside of an open domain, or a place that is none. Particles of periodic
/// domains are brought back.
template <int D, class Backend>
void requireInside(Context<Backend>& context, const CellGrid<D>& grid, const Particles<D, Backend>& particles,
                   Buffer<Vec<D>, Backend>& position) {
  Buffer<Vec<D>, Backend> inside;
  inside.resize(context, position.size());
  const std::uint32_t out = moveParticles<D>(context, grid, 0, position.span(),
                                             particles.velocity.span().first(position.size()), inside.span());
  if (out != noParticle) {
    Vec<D> x{};
    copyToHost(context, std::span<const Vec<D>>(position).subspan(out, 1), &x);
    std::string place;
    for (int k = 0; k < D; ++k) place += fmt::format("{}{:g}", k > 0 ? ", " : "", x[k]);
    throw InputError(
        fmt::format("positions: expected places in the domain [m], found ({}) for particle {}", place, out));
  }
  position = std::move(inside);
}

/// Errors: InputError for numbers that are not finite, or of which holds(number) is false. `expected`: as in
/// messages.
template <class Backend, class Holds>
void requireNumbers(Context<Backend>& context, const Buffer<double, Backend>& values, const char* what,
                    const char* expected, Holds&& holds) {
  Buffer<double> host(values.size());
  copyToHost(context, values.span(), host.data());
  for (std::size_t i = 0; i < host.size(); ++i)
    if (!(std::isfinite(host[i]) && holds(host[i])))
      throw InputError(fmt::format("{}: expected {}, found {:g} for particle {}", what, expected, host[i], i));
}

/// The fluid of a state gets room for factors of its viscosities, and for the shear rates that go with them.
template <int D, class Backend>
void haveViscosityFactors(FlowState<D, Backend>& state) {
  Particles<D, Backend>& p = state.particles;
  state.theCase.haveViscosityFactors();
  p.has.viscosityFactors = true;
  p.viscosityFactor.resize(state.context, p.fluidCount);
  if (std::exchange(p.has.shearRates, true)) return;
  p.shearRate.resize(state.context, p.fluidCount);
  clearValues(state.context, p.shearRate.span());
}

/// What was given, in the backend's memory and found to be possible; empty where nothing was.
template <int D, class Backend>
struct CheckedFluid {
  Buffer<Vec<D>, Backend> position, velocity;
  Buffer<double, Backend> temperature, viscosityFactor;
  std::array<Buffer<double, Backend>, maxStates> states;

  /// `energy(velocity)`: the kinetic energy with these. Errors: InputError.
  template <class Energy>
  static CheckedFluid of(Context<Backend>& context, MethodKind method, const GivenFluid& given,
                         const CellGrid<D>& grid, const Particles<D, Backend>& particles, Energy&& energy) {
    const std::uint32_t n = particles.fluidCount;
    if (std::is_same_v<Backend, Cuda> && given.where == BackendKind::Cuda) waitForDevice();
    const auto here = [&]<class T>(Buffer<T, Backend>& to, std::span<const double> values, const char* what) {
      if (!values.empty() || n == 0) to = broughtHere<T>(context, values, given.where, n, what);
    };
    CheckedFluid fluid;
    here(fluid.position, given.position, "positions");
    here(fluid.velocity, given.velocity, "velocities");
    here(fluid.temperature, given.temperature, "temperatures");
    here(fluid.viscosityFactor, given.viscosityFactor, "viscosity_factors");
    for (std::size_t k = 0; k < particles.has.states; ++k) {
      if (!given.states[k].empty()) here(fluid.states[k], given.states[k], "states");
      requireNumbers(context, fluid.states[k], "states", "finite numbers", [](double) { return true; });
    }
    if (fluid.position.size() > 0) requireInside(context, grid, particles, fluid.position);
    if (fluid.velocity.size() > 0 && !std::isfinite(energy(fluid.velocity.span())))
      throw InputError("velocities: expected finite numbers [m/s], found others");
    if (fluid.temperature.size() > 0 && !particles.has.temperatures)
      throw InputError("temperatures: the case has no heat; expected a case with [heat]");
    if (fluid.viscosityFactor.size() > 0 && method != MethodKind::MphI)
      throw InputError(
          "viscosity_factors: expected a case of the method 'mph-i', where particles can have their own");
    const auto isPositive = [](double x) { return x > 0; };
    requireNumbers(context, fluid.temperature, "temperatures", "positive numbers [K]", isPositive);
    requireNumbers(context, fluid.viscosityFactor, "viscosity_factors", "positive numbers", isPositive);
    return fluid;
  }

  void copyTo(Context<Backend>& context, Particles<D, Backend>& particles) const {
    const auto copy = [&](const auto& from, auto& to) {
      if (from.size() > 0) copyValues(context, from.span(), to.data());
    };
    copy(position, particles.position), copy(velocity, particles.velocity);
    copy(temperature, particles.temperature), copy(viscosityFactor, particles.viscosityFactor);
    for (std::size_t k = 0; k < states.size(); ++k) copy(states[k], particles.states[k]);
  }
};

}  // namespace treacle
