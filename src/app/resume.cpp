#include "resume.hpp"

#include "changed_bodies.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/motion/carried_probe.hpp"
#include "treacle/model/motion/nozzle.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/flow/gas_cells.hpp"
#include "treacle/step/flow/outflow_start.hpp"
#include "treacle/step/readings/wall_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace treacle {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("--resume {}: {}", file.string(), why));
}

template <int D>
bool isInside(const Domain& domain, const Vec<D>& x) {
  for (int k = 0; k < D; ++k)
    if (!(x[k] >= domain.min[k] && x[k] <= domain.max[k])) return false;  // NaN as well
  return true;
}

/// The methods take different things out of a state: pressures of one mean nothing to the other.
void requireMethod(const Case& c, const std::filesystem::path& file, MethodKind method) {
  if (method != c.method.kind)
    refuse(file, fmt::format("a state of the method '{}', but that of the case is '{}'", nameOf(method),
                             nameOf(c.method.kind)));
}

std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("'{}'", fmt::join(names, "', '"));
}

/// Gives particles the numbers that their materials have in the case, which may list them in another order.
/// Errors: InputError for materials that the case does not have.
template <int D>
void matchMaterials(const Case& c, const std::filesystem::path& file, const StateNames& names, Particles<D>& p) {
  if (names.materials.empty()) return;
  const std::vector<std::string> here = StateNames::of(c).materials;
  std::vector<std::uint8_t> number(names.materials.size());
  for (std::size_t m = 0; m < number.size(); ++m) {
    const auto found = std::ranges::find(here, names.materials[m]);
    const bool used = std::ranges::find(p.material, m) != p.material.end();
    if (found == here.end() && used)
      refuse(file,
             fmt::format("its particles are of the material '{}', but the case has {}; expected the materials of "
                         "the run, in any order",
                         names.materials[m], listed(here)));
    number[m] = static_cast<std::uint8_t>(found == here.end() ? 0 : found - here.begin());
  }
  for (std::uint8_t& m : p.material)
    if (m < number.size()) m = number[m];
}

/// Walls that keep their velocity go on with that of the case; others get theirs in each step.
template <int D>
void setWallVelocities(const Case& c, const Particles<D>& made, std::uint32_t first, Particles<D>& p) {
  const auto keepsIt = [&](const Body& b) {
    return b.kind == BodyKind::Wall && !b.rotation && b.oscillation.period == 0 && !isDriven(b.displacement);
  };
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i)
    if (keepsIt(c.bodies[p.body[i]])) p.velocity[i] = made.velocity[made.fluidCount + p.id[i] - first];
}

/// Numbers of particles of the kinds.
struct Kinds {
  std::uint32_t fluid = 0, walls = 0;
};

Kinds kindsOf(const MadeParticles& made) {
  Kinds kinds;
  for (const BodyCount& body : made.ofBodies) kinds.fluid += body.fluid, kinds.walls += body.wall;
  return kinds;
}

/// What a fluid of unknown temperature would start with nobody can say, and factors of its viscosity that come or
/// go would make another fluid of it.
template <int D>
void requireFields(const Case& c, const std::filesystem::path& file, const StateNames& names,
                   const Particles<D>& p) {
  if (c.heat && !p.has.temperatures) refuse(file, "a state without temperatures, but the case has heat");
  if (c.hasViscosityFactors() && !p.has.viscosityFactors)
    refuse(file, "a state without factors of the viscosity, but a body of the case has a viscosity_factor");
  if (c.hasThinSheets() != p.has.sides)
    refuse(file, fmt::format("a state with{} thin sheets, but the case has {}; expected the case.toml of the run",
                             p.has.sides ? "" : "out", p.has.sides ? "none" : "some"));
  if (c.elasticModes() != p.has.elasticModes)
    refuse(file,
           fmt::format("a state with {} elastic modes, but the case has {}; expected the case.toml of the run",
                       p.has.elasticModes, c.elasticModes()));
  if (const auto here = c.stateNames(); here != names.states)
    refuse(file, fmt::format("a state whose materials have the states {}, but those of the case have {}; expected "
                             "the case.toml of the run",
                             listed(names.states), listed(here)));
  if (!c.hasViscosityFactors() && p.has.viscosityFactors)
    refuse(file,
           "a state with factors of the viscosity, but no body of the case has a viscosity_factor; expected the "
           "case.toml of the run, or viscosity_factor = 1");
}

template <int D>
void requireFit(const Case& c, const std::filesystem::path& file, const Checkpoint<D>& state, const Kinds& made,
                bool isChanged) {
  const Particles<D>& p = state.particles;
  if ((state.fluidOfAll != made.fluid && !c.isOpen() && !isChanged) || state.wallsOfAll != made.walls)
    refuse(file,
           fmt::format("{} fluid and {} wall particles, but the case has {} and {}; expected the case and the "
                       "resolution that were run",
                       state.fluidOfAll, state.wallsOfAll, made.fluid, made.walls));
  for (std::uint32_t i = 0; i < p.count; ++i) {
    if (p.material[i] >= c.materials.size())
      refuse(file, fmt::format("particle {} has material {}, but the case has only {}", p.id[i], p.material[i],
                               c.materials.size()));
    if (!isInside(c.domain, p.position[i]))
      refuse(file, fmt::format("particle {} lies outside the domain of the case", p.id[i]));
  }
}

/// What a file of a case without inflows, outflows and openings does not have begins with the run.
void requireFlow(const Case& c, const std::filesystem::path& file, const OpenFlow& flow) {
  if (flow.nextId == 0) return;
  if (flow.inflows.size() != c.bodies.size() || flow.outflows.size() != c.outflows.size() ||
      flow.openings.size() != c.openings.size())
    refuse(file, fmt::format("a state of {} bodies, {} outflows and {} openings, but the case has {}, {} and {}",
                             flow.inflows.size(), flow.outflows.size(), flow.openings.size(), c.bodies.size(),
                             c.outflows.size(), c.openings.size()));
}

/// The columns of a nozzle go on from where each is; those of a plug are all at the same place. Errors:
/// InputError.
template <int D>
void requireColumns(const Case& c, const std::filesystem::path& file, const OpenFlow& flow) {
  for (std::size_t b = 0; b < flow.inflows.size(); ++b) {
    const Body& body = c.bodies[b];
    const std::size_t before = flow.inflows[b].ways.size();
    const std::size_t now = body.kind == BodyKind::Inflow ? NozzleLayers<D>(c, body).profile().size() : 1;
    if (before > 1 && before != now)
      refuse(file,
             fmt::format("the {} columns of particles in the nozzle of inflow '{}' went at speeds of their own; "
                         "expected the nozzle of the run, and a profile other than \"{}\"",
                         before, body.name, plugProfile));
  }
}

/// Errors: InputError for gas of another domain or spacing.
void requireGas(const Case& c, const std::filesystem::path& file, const GasState& gas) {
  if (!gas.cells.empty() && *std::ranges::max_element(gas.cells) >= static_cast<double>(gasCells(c)))
    refuse(file, "its trapped gas is outside the domain of the case; expected the domain of the run");
}

/// Where rigid bodies are, and what they weigh, only the state says. Errors: InputError for other ones.
void requireRigid(const Case& c, const std::filesystem::path& file, const StateNames& names,
                  const RigidMotion& rigid) {
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    std::size_t before = b;
    if (!names.bodies.empty()) {
      const auto found = std::ranges::find(names.bodies, c.bodies[b].name);
      if (found == names.bodies.end()) continue;
      before = static_cast<std::size_t>(found - names.bodies.begin());
    }
    const bool known = before < rigid.bodies.size() && rigid.bodies[before].mass > 0;
    if (known != (c.bodies[b].kind == BodyKind::Rigid))
      refuse(file, fmt::format("body '{}' is {} in the state", c.bodies[b].name,
                               known ? "a rigid one" : "no rigid one"));
  }
}

/// Rigid bodies have the masses that the case gives them now; inertia goes with mass.
template <int D>
void setMasses(const Case& c, const MadeParticles& made, Particles<D>& state) {
  RigidMotion& rigid = state.rigid;
  for (std::size_t b = 0; b < rigid.bodies.size(); ++b) {
    RigidBody& body = rigid.bodies[b];
    if (body.mass == 0) continue;
    const double given = c.bodies[b].rigid.mass,
                 own = c.materials[static_cast<std::size_t>(c.bodies[b].material)].density *
                       std::pow(c.spacing, D) * made.ofBodies[b].wall;
    const double ratio = (given > 0 ? given : own) / body.mass;
    if (std::abs(ratio - 1) < 1e-9) continue;  // the rounding of a sum
    body.mass *= ratio;
    for (double& moment : body.inertia) moment *= ratio;
    state.response.clear();
  }
}

/// A body that the case lets go later only, but that was free in the run, stands still until then.
template <int D>
void holdBodies(const Case& c, Checkpoint<D>& state, std::vector<std::string>& changes) {
  Particles<D>& p = state.particles;
  for (std::size_t b = 0; b < p.rigid.bodies.size(); ++b) {
    RigidBody& body = p.rigid.bodies[b];
    const double release = c.bodies[b].rigid.release;
    const bool isHeld = body.mass > 0 && state.time < release - 0.5 * c.time.step;  // as in the steps
    if (!isHeld || (norm(body.velocity) == 0 && norm(body.spin) == 0)) continue;
    body.velocity = body.spin = {};
    for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
      if (p.body[i] == b) p.velocity[i] = {};
    p.rigid.change.clear(), p.response.clear();
    changes.push_back(fmt::format("--resume: body '{}' is held and stands still until its release at t = {:g} s",
                                  c.bodies[b].name, release));
  }
}

/// The layers of an inflow stand where the state says, so its nozzle must be where it was in the run. Nozzles that
/// turn are not checked. Errors: InputError.
template <int D>
void requireNozzles(const Case& c, const std::filesystem::path& file, const Particles<D>& made,
                    std::uint32_t first, const Checkpoint<D>& state) {
  const Particles<D>& p = state.particles;
  for (std::uint32_t i = p.wallBegin(); i < p.count; ++i) {
    const Body& body = c.bodies[p.body[i]];
    if (body.kind != BodyKind::Inflow || body.rotation) continue;
    Vec<D> off = p.position[i] - made.position[made.fluidCount + p.id[i] - first] -
                 resized<D>(wallDisplacement(body, state.time));
    const Vec<D> direction = resized<D>(body.inflow.nozzle.direction * (1 / norm(body.inflow.nozzle.direction)));
    for (int k = 0; k < D; ++k)
      if (c.domain.periodic[static_cast<std::size_t>(k)]) {
        const double period = c.domain.max[k] - c.domain.min[k];
        off[k] -= period * std::round(off[k] / period);
      }
    if (norm(off - dot(off, direction) * direction) > 0.01 * c.spacing)
      refuse(file,
             fmt::format("inflow '{}' is not where it was in the run; expected its nozzle unchanged", body.name));
  }
}

/// Errors: InputError for a body that the case does not have, or that is of the other kind.
template <int D>
void requireBodies(const Case& c, const std::filesystem::path& file, const Particles<D>& p) {
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const BodyKind kind = i < p.fluidCount ? BodyKind::Fluid : BodyKind::Wall;
    const auto fits = [&](const Body& body) {
      return kind == BodyKind::Fluid ? body.holdsFluid() : body.kind != BodyKind::Fluid;
    };
    if (p.body[i] >= c.bodies.size() || !fits(c.bodies[p.body[i]]))
      refuse(file, fmt::format("particle {} belongs to body {}, which is no {} body of the case", p.id[i],
                               p.body[i], nameOf(kind)));
  }
}

/// Surfaces of walls follow from the case; a file does not have them. The ids of what the case makes are its
/// places. `first`: the id of the first wall that was made.
template <int D>
void setWallSurfaces(const Particles<D>& made, std::uint32_t first, Particles<D>& p) {
  p.wallSurface.resize(made.wallSurface.size());
  for (std::size_t k = 0; k < p.wallSurface.size(); ++k)
    p.wallSurface[k] = made.wallSurface[p.id[p.fluidCount + k] - first];
}

std::int64_t stepAt(double time, const TimeSettings& settings, const std::filesystem::path& file) {
  const double steps = time / settings.step, whole = std::round(steps);
  if (steps > maxSteps)
    refuse(file, fmt::format("its time {:g} s is more steps of {:g} s than can be counted", time, settings.step));
  if (!(std::abs(steps - whole) < 1e-6))
    refuse(file, fmt::format("its time {:g} s is not a whole number of steps of {:g} s (time.step)", time,
                             settings.step));
  return static_cast<std::int64_t>(whole);
}

/// Patches that no wall particle is behind when the run starts.
template <int D>
void noteEmptyPatches(const Case& c, const Particles<D>& p, std::vector<std::string>& notes) {
  for (const Probe& probe : c.probes) {
    if (probe.kind != ProbeKind::WallPressure) continue;
    const auto body = std::ranges::find(c.bodies, probe.body, &Body::name);
    if (body->kind == BodyKind::Rigid && p.rigid.bodies.empty()) continue;  // its centre of mass is not known yet
    const auto patch = WallPatch<D>::of(carriedProbe(probe, c, p.rigid.bodies, 0), c);
    double particles = 0;
    for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
      if (p.body[i] == patch.body) particles += patch.share(patch.way(p.position[i]));
    if (particles > 0) continue;
    notes.push_back(fmt::format(
        "probe '{}': no particle of '{}' is behind its patch, so it will read 0; expected a patch on the "
        "surface of this body, and of the fluid's side",
        probe.name, probe.body));
  }
}

}  // namespace

MadeParticles MadeParticles::of(const Case& c, std::vector<std::string>& notes, ParticlePart part) {
  MadeParticles made;
  made.part = part;
  made.particles = createParticles(c, notes, &made.ofBodies, part);
  if (part.isAll()) {
    noteFluidInOutflows(c, fluidInOutflows(c, made.particles), made.particles.numbers().fluid, notes);
    made.particles.visit([&]<int D>(const Particles<D>& p) { noteEmptyPatches<D>(c, p, notes); });
  }
  return made;
}

void MadeParticles::requireParticles(const Case& c) const {
  const bool some = std::ranges::any_of(ofBodies, [](const BodyCount& body) { return body.fluid > 0; });
  if (!some && c.hasInflow())
    throw InputError(
        "the case has no fluid at the start: no body of type \"fluid\" holds a particle, and no inflow flows yet; "
        "give an inflow a small speed at t = 0, or add a body of fluid");
  for (std::size_t b = 0; b < c.bodies.size(); ++b)
    if (c.bodies[b].kind == BodyKind::Rigid && ofBodies[b].wall == 0)
      throw InputError(
          fmt::format("rigid body '{}' has no particles; make it larger than the spacing {:g} m, or put "
                      "it on points of the lattice",
                      c.bodies[b].name, c.spacing));
}

StartState fittingState(const Case& c, const std::filesystem::path& file, const MadeParticles& made) {
  StartState start = made.particles.visit([&]<int D>(const Particles<D>& created) -> StartState {
    Checkpoint<D> state = readCheckpoint<D>(file, made.part);
    const Kinds kinds = kindsOf(made);
    std::vector<std::string> changes;
    requireMethod(c, file, state.method);
    matchMaterials(c, file, state.names, state.particles);
    requireFields(c, file, state.names, state.particles);
    requireRigid(c, file, state.names, state.particles.rigid);
    requireGas(c, file, state.particles.gas);
    if (!state.names.bodies.empty() && state.names.bodies != StateNames::of(c).bodies)
      changeBodies<D>(c, file, made, created, state, changes);
    requireFit(c, file, state, kinds, !changes.empty());
    requireFlow(c, file, state.particles.flow);
    requireColumns<D>(c, file, state.particles.flow);
    setMasses<D>(c, made, state.particles);
    holdBodies<D>(c, state, changes);
    requireBodies(c, file, state.particles);
    const std::uint32_t firstWall = state.firstWall + made.part.begin(kinds.walls);
    requireNozzles(c, file, created, firstWall, state);
    setWallSurfaces(created, firstWall, state.particles);
    setWallVelocities(c, created, firstWall, state.particles);
    return {std::move(state.particles), state.step, state.time, std::move(changes)};
  });
  if (!c.time.stepsVary()) start.step = stepAt(start.time, c.time, file);
  return start;
}

StartState resumedState(const Case& c, const std::filesystem::path& file, const MadeParticles& made) {
  StartState state = fittingState(c, file, made);
  if (c.atEnd(state.step, state.time))
    refuse(file, fmt::format("its time {:g} s is not before the end of the run, {:g} s; choose a later one with "
                             "--end-time",
                             state.time, c.time.end));
  return state;
}

}  // namespace treacle
