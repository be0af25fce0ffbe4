#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/open_flow.hpp"
#include "treacle/model/geometry/side.hpp"
#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/model/materials/elastic_mode.hpp"
#include "treacle/model/materials/material_state.hpp"
#include "treacle/model/motion/rigid_body.hpp"
#include "treacle/model/state/bulk_memory.hpp"
#include "treacle/model/state/gas_state.hpp"
#include "treacle/model/state/solver_modes.hpp"
#include "treacle/model/state/step_memory.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace treacle {

/// Which fields there are that not every case needs, or not at every time.
struct FluidExtras {
  bool shearRates = false;        // where viscosities are particles' own (Case::hasOwnViscosities)
  bool temperatures = false;      // with heat
  bool viscosityFactors = false;  // where some body gives one
  std::uint8_t states = 0;        // how many materials have (Case::stateNames)
  std::uint8_t elasticModes = 0;  // how many fluids have
  bool starts = false;            // within a step whose forces are those of its middle; walls have it, too
  bool sides = false;             // with thin sheets; walls have them, too

  /// The extra fields of a set of walls without fluid, between steps.
  FluidExtras ofWalls() const {
    FluidExtras walls;
    walls.sides = sides;
    return walls;
  }

  bool operator==(const FluidExtras&) const = default;
};

/// What the fluid remembers of earlier steps; nothing before the first one. Sets without shear rates have no field
/// of them.
template <class F, class... Sets>
void forEachFlowMemoryOf(F&& f, Sets&... sets) {
  f(sets.acceleration...), f(sets.jerk...);
  if ((sets.has.shearRates && ...)) f(sets.shearRate...);
}

/// The fields that walls do not have. Likewise of temperatures, factors and states.
template <class F, class... Sets>
void forEachFluidFieldOf(F&& f, Sets&... sets) {
  forEachFlowMemoryOf(f, sets...);
  if ((sets.has.temperatures && ...)) f(sets.temperature...);
  if ((sets.has.viscosityFactors && ...)) f(sets.viscosityFactor...);
  for (std::size_t k = 0; k < maxStates; ++k)
    if (((k < sets.has.states) && ...)) f(sets.states[k]...);
  for (std::size_t k = 0; k < maxElasticModes; ++k)
    if (((k < sets.has.elasticModes) && ...)) f(sets.conformation[k]...);
}

/// The fields that fluid and walls have.
template <class F, class... Sets>
void forEachSharedFieldOf(F&& f, Sets&... sets) {
  f(sets.position...), f(sets.velocity...), f(sets.pressure...), f(sets.numberDensity...), f(sets.heldPressure...),
      f(sets.material...), f(sets.body...), f(sets.id...);
  if ((sets.has.starts && ...)) f(sets.start...);
  if ((sets.has.sides && ...)) f(sets.side...);
}

/// The fields that walls alone have; empty where nothing is known.
template <class F, class... Sets>
void forEachWallFieldOf(F&& f, Sets&... sets) {
  f(sets.wallSurface...);
}

/// Calls f with every field of the sets of particles, f(a.position, b.position, ...) and so on: what permutes,
/// saves, copies or compares particles cannot forget one.
template <class F, class... Sets>
void forEachFieldOf(F&& f, Sets&... sets) {
  forEachSharedFieldOf(f, sets...);
  forEachFluidFieldOf(f, sets...);
  forEachWallFieldOf(f, sets...);
  f(sets.modes.vectors...);
}

/// How many particles of each kind, modes of the solver and known surfaces of walls there are.
struct ParticleNumbers {
  std::uint64_t fluid = 0, wall = 0, modes = 0, surfaces = 0;
  std::uint64_t ghosts = 0;  // fluid of other processes
  FluidExtras has{};

  bool operator==(const ParticleNumbers&) const = default;
};

/// The only owner of per-particle fields. Fluid particles come first, [0, fluidCount), then wall particles,
/// [wallBegin(), count); inside both groups the search keeps them sorted by cell. `id` names a particle for
/// good: 0 … count-1 in the order of creation, and then in the order in which fluid comes in. Where processes
/// share a simulation, fluidCount is the number of the fluid particles that this one owns, and behind them stand
/// the ghosts: those of other processes that it needs, with position and material alone.
template <int D, class Backend = Cpu>
struct Particles {
  std::uint32_t fluidCount = 0;
  std::uint32_t ghostCount = 0;
  std::uint32_t count = 0;

  Buffer<Vec<D>, Backend> position;        // x [m]
  Buffer<Vec<D>, Backend> velocity;        // u [m/s]
  Buffer<double, Backend> pressure;        // Psi [Pa]
  Buffer<double, Backend> numberDensity;   // n [-]
  Buffer<double, Backend> heldPressure;    // tension of the fluid, below zero (mph/tension.hpp) [Pa]
  Buffer<std::uint8_t, Backend> material;  // index into Case::materials
  Buffer<std::uint8_t, Backend> body;      // index into Case::bodies
  Buffer<std::uint32_t, Backend> id;

  Buffer<Vec<D>, Backend> start;  // x at the start of the step at hand [m]; empty unless it has it

  Buffer<std::uint32_t, Backend> side;  // of thin sheets (sides); empty unless the case has some

  // The memory of the flow: what the first guess of a solve is extrapolated from. Walls have none, and it is not
  // part of the state that frames show. Undefined before the first step.
  Buffer<Vec<D>, Backend> acceleration;  // (u^k - u^{k-1}) / dt of the fluid [m/s2]; zero: not known
  Buffer<Vec<D>, Backend> jerk;          // that of the acceleration, of the fluid [m/s3]; zero: not known

  // Of the fluid; empty unless it has them.
  FluidExtras has{};
  Buffer<double, Backend> shearRate;        // sqrt(2 E:E) that the next solve takes the viscosity from [1/s]
  Buffer<double, Backend> temperature;      // T [K]
  Buffer<double, Backend> viscosityFactor;  // by which the viscosity of the material is multiplied [-]
  // In the order of Case::stateNames; those that a particle's material does not have are 0.
  std::array<Buffer<double, Backend>, maxStates> states;
  // Of the elastic modes of its material: c; the unit matrix where it has none, or is relaxed.
  std::array<Buffer<SymmetricBlock<D>, Backend>, maxElasticModes> conformation;

  // The memory of the solver, likewise.
  SolverModes<D, Backend> modes;

  // That of the time steps, likewise.
  StepMemory steps;

  // That of bulk constants that follow the density, likewise.
  BulkMemory bulk;

  // Of the fluid that comes and goes, which is part of the state.
  OpenFlow flow;

  // Of the bodies that it moves, likewise.
  RigidMotion rigid;

  // Of the gas that it has trapped, likewise.
  GasState gas;

  // What the search for the unknowns of a step remembers: by how much each misses what it should be, derived by
  // all of them, row by row (StepUnknowns); empty: nothing.
  std::vector<double> response;

  // Of wall particle wallBegin() + k. Empty: walls have no surface, and the fluid meets their velocities where
  // their particles are.
  Buffer<WallSurface<D>, Backend> wallSurface;

  /// All that is not a field.
  template <class Other>
  void copyNumbers(const Particles<D, Other>& from) {
    modes.copyNumbers(from.modes);
    steps = from.steps;
    bulk = from.bulk;
    flow = from.flow;
    rigid = from.rigid;
    gas = from.gas;
    response = from.response;
  }

  std::uint32_t wallBegin() const { return fluidCount + ghostCount; }
  std::uint32_t wallCount() const { return count - wallBegin(); }
  std::uint32_t modeCount() const {
    return fluidCount > 0 ? static_cast<std::uint32_t>(modes.vectors.size() / fluidCount) : 0;
  }

  /// Bytes of the largest field of so many particles, `fluid` of them fluid.
  std::size_t largestField(std::size_t particles, std::size_t fluid) const {
    return std::max(particles * sizeof(Vec<D>), has.elasticModes > 0 ? fluid * sizeof(SymmetricBlock<D>) : 0);
  }

  ParticleNumbers numbers() const {
    return {fluidCount, wallCount(), modeCount(), wallSurface.size(), ghostCount, has};
  }

  /// The content is undefined afterwards. Errors: std::bad_alloc.
  void resize(std::uint32_t fluid, std::uint32_t wall,
              std::uint32_t modeNumber = 0) requires std::is_same_v<Backend, Cpu> {
    resize(Context<Cpu>{}, {fluid, wall, modeNumber});
  }
  void resize(const ParticleNumbers& numbers) requires std::is_same_v<Backend, Cpu> {
    resize(Context<Cpu>{}, numbers);
  }
  void resize(const Context<Backend>& context, const ParticleNumbers& numbers) {
    const auto fluid = static_cast<std::uint32_t>(numbers.fluid), wall = static_cast<std::uint32_t>(numbers.wall);
    fluidCount = fluid;
    ghostCount = static_cast<std::uint32_t>(numbers.ghosts);
    count = fluid + ghostCount + wall;
    const auto resizeTo = [&](std::uint32_t size) {
      return [&, size](auto& field) { field.resize(context, size); };
    };
    has = numbers.has;
    start.resize(context, 0), side.resize(context, 0);
    for (auto* field : {&shearRate, &temperature, &viscosityFactor}) field->resize(context, 0);
    for (auto& state : states) state.resize(context, 0);
    for (auto& mode : conformation) mode.resize(context, 0);
    forEachSharedFieldOf(resizeTo(count), *this);
    forEachFluidFieldOf(resizeTo(fluid), *this);
    modes.vectors.resize(context, fluid * numbers.modes);
    modes.age = {};
    modes.pressure = {};
    steps = {};
    bulk = {};
    flow = {};
    rigid = {};
    gas = {};
    response = {};
    wallSurface.resize(context, numbers.surfaces);
  }

  /// Calls f with every field.
  template <class F>
  void forEachField(F&& f) {
    forEachFieldOf(f, *this);
  }
  template <class F>
  void forEachField(F&& f) const {
    forEachFieldOf(f, *this);
  }
};

}  // namespace treacle
