#include "open_boundaries.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/search/fluid_change.hpp"
#include "treacle/step/walls/wall_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace treacle {
namespace {

/// Appends one at rest in its own fields; those of the flow's memory are zero.
template <int D>
void appendParticles(Particles<D>& p, const std::vector<Vec<D>>& places) {
  const std::uint32_t before = p.fluidCount;
  Particles<D> more;
  ParticleNumbers numbers = p.numbers();
  numbers.fluid += places.size();
  more.resize(numbers);
  const auto copy = [&]<class T>(const Buffer<T>& from, Buffer<T>& to) {
    std::copy(from.begin(), from.end(), to.begin());
    std::fill(to.begin() + before, to.end(), T{});
  };
  forEachSharedFieldOf(copy, p, more);
  forEachFluidFieldOf(copy, p, more);
  std::copy(places.begin(), places.end(), more.position.begin() + before);
  p = std::move(more);
}

}  // namespace

template <int D, class Backend>
OpenBoundaries<D, Backend>::OpenBoundaries(FlowState<D, Backend>& state)
    : state_(state), volume_(std::pow(state.theCase.spacing, D)) {
  std::vector<OutflowRegion<D>> regions;
  for (const Outflow& o : state.theCase.outflows) regions.push_back(OutflowRegion<D>::of(o));
  for (const OpeningFace<D>& face : state.faces) regions.push_back(OutflowRegion<D>::of(face.place()));
  fromHost(state.context, std::span<const OutflowRegion<D>>(regions), regions_);
  std::size_t columns = 0;
  for (const auto& nozzle : state.nozzles)
    if (nozzle) columns = std::max(columns, nozzle->eachOf({}, {}).size());
  state.nozzleColumns.resize(state.context, columns);  // no step fails for them when it has changed the state
}

template <int D, class Backend>
void OpenBoundaries<D, Backend>::begin(Particles<D>& particles) const {
  const Case& c = state_.theCase;
  if (!c.isOpen()) {
    particles.flow = {};
    return;
  }
  const auto count = static_cast<std::uint32_t>(sumOverProcesses(state_.context, particles.count));
  if (particles.flow.nextId != 0) return;
  particles.flow.nextId = count;
  particles.flow.inflows.resize(c.bodies.size());
  particles.flow.outflows.resize(c.outflows.size());
  particles.flow.openings.resize(c.openings.size());
}

template <int D, class Backend>
bool OpenBoundaries<D, Backend>::follow(const CellGrid<D>& grid, double start, double density) {
  if (!state_.theCase.isOpen()) return false;
  Particles<D, Backend>& p = state_.particles;
  Change change;
  change.flow = p.flow;
  ParticleNumbers none;
  none.has = p.has;
  change.added.resize(none);
  for (std::size_t k = 0; k < drag_.size(); ++k) change.flow.openings[k].drag = drag_[k];
  letOut(change);
  letIn(grid, start, change);
  if (!state_.faces.empty()) fillReserves(grid, change);
  const std::uint64_t came = change.added.fluidCount, all = state_.fluidOfAll + came - change.left;
  if (all == 0) throw EndOfRun("no fluid is left: all of it has gone out by the outflows");
  if (all > maxParticles)
    throw RunError(fmt::format("inflows have filled the case with {} fluid particles, more than the limit of {}",
                               all, maxParticles));
  const bool changes = change.left + came > 0;
  if (changes) {
    std::fill(change.added.numberDensity.begin(), change.added.numberDensity.end(), density);
    // The first process has them all: the sort takes them to where they belong.
    if (state_.context.communicator && state_.context.communicator->rank() > 0) change.added.resize(none);
    const std::span<const std::uint8_t> nobody;
    changeFluid<D>(state_.context, change.left > 0 ? std::span<const std::uint8_t>(gone_) : nobody, change.added,
                   p);
    state_.fluidOfAll = static_cast<std::uint32_t>(all);
  }
  const std::uint32_t walls = p.wallBegin();
  for (std::size_t b = 0; b < change.setBack.size(); ++b)
    if (!change.setBack[b].empty())
      shiftColumns<D>(
          state_.context, grid,
          state_.columnsOf(b, state_.time, change.setBack[b], -1.0 * state_.nozzles[b]->direction(state_.time)),
          p.body.span().subspan(walls), p.position.span().subspan(walls));
  p.flow = std::move(change.flow);
  return changes;
}

/// Marks what has left.
template <int D, class Backend>
void OpenBoundaries<D, Backend>::letOut(Change& change) {
  if (regions_.empty()) return;
  Particles<D, Backend>& p = state_.particles;
  const std::uint32_t n = p.fluidCount;
  gone_.resize(state_.context, n);
  std::vector<std::uint32_t> counts = markOutflow<D>(
      state_.context, {regions_.span(), p.position.span().first(n), p.material.span().first(n)}, gone_.span());
  sumOverProcesses(state_.context, std::span(counts));
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    change.left += counts[k];
    const std::size_t region = k / maxMaterials, outflows = change.flow.outflows.size();
    (region < outflows ? change.flow.outflows[region] : change.flow.openings[region - outflows].out) +=
        {counts[k], counts[k] * volume_ * state_.theCase.materials[k % maxMaterials].density};
  }
}

/// The columns of all inflows have gone on. Their particles that have left the nozzles are fluid now, and as many
/// follow.
template <int D, class Backend>
void OpenBoundaries<D, Backend>::letIn(const CellGrid<D>& grid, double start, Change& change) const {
  const double spacing = state_.theCase.spacing, dt = state_.timeStep;
  change.setBack.resize(state_.nozzles.size());
  for (std::size_t b = 0; b < state_.nozzles.size(); ++b) {
    if (!state_.nozzles[b]) continue;
    const NozzleLayers<D>& nozzle = *state_.nozzles[b];
    const std::span<const double> profile = nozzle.profile();
    std::vector<double>& ways = change.flow.inflows[b].ways;
    ways.resize(profile.size(), ways.front());
    const double speed = nozzle.speed(start, dt);
    std::vector<double> counts(ways.size());  // of particles that leave, per column
    for (std::size_t k = 0; k < ways.size(); ++k) {
      ways[k] += dt * (speed * profile[k]);
      counts[k] = std::floor(ways[k] / spacing * (1 + 1e-9));
    }
    const double layers = std::ranges::max(counts);
    if (layers == 0) continue;
    if (layers > nozzle.depth())
      throw RunError(fmt::format(
          "inflow '{}' goes {:.3g} spacings in a step of {:.3g} s, expected at most {}; take "
          "shorter steps, {} <= {:.2g}",
          state_.theCase.bodies[b].name, layers, dt, nozzle.depth(), state_.theCase.time.stepKey(), dt / layers));
    for (int layer = 0; layer < static_cast<int>(layers); ++layer) addLayer(grid, b, layer, counts, change);
    for (std::size_t k = 0; k < ways.size(); ++k) {
      change.setBack[b].push_back(counts[k] * spacing);
      ways[k] = std::max(0.0, ways[k] - counts[k] * spacing);
    }
  }
}

/// One particle of each column from which more than `layer` come.
template <int D, class Backend>
void OpenBoundaries<D, Backend>::addLayer(const CellGrid<D>& grid, std::size_t body, int layer,
                                          std::span<const double> counts, Change& change) const {
  const NozzleLayers<D>& nozzle = *state_.nozzles[body];
  const Body& b = state_.theCase.bodies[body];
  const Incoming incoming{fmt::format("the nozzle of inflow '{}'", b.name), b.material, body, b.temperature,
                          b.viscosityFactor};
  const double spacing = state_.theCase.spacing, dt = state_.timeStep, start = state_.time - dt;
  std::vector<double> ways = change.flow.inflows[body].ways;
  for (double& way : ways) way -= (layer + 0.5) * spacing;
  std::vector<Vec<D>> places = nozzle.layer(ways, state_.time);
  std::vector<Vec<D>> excess;  // beside the motion of the layers [m/s]
  if (!nozzle.isPlug()) {
    const Vec<D> mean = nozzle.speed(start, dt) * nozzle.direction(state_.time);
    const std::vector<double> parts = nozzle.excess();
    std::vector<Vec<D>> out;
    for (std::size_t k = 0; k < places.size(); ++k)
      if (counts[k] > layer) out.push_back(places[k]), excess.push_back(parts[k] * mean);
    places = std::move(out);
  }
  const std::uint32_t first = add(grid, incoming, std::move(places), change.flow.inflows[body], change);
  const WallMotion<D> motion = nozzle.motionAtEnd(state_.theCase.domain, start, dt);
  for (std::uint32_t i = first; i < change.added.fluidCount; ++i)
    change.added.velocity[i] = motion.velocityAt(change.added.position[i]);
  for (std::size_t k = 0; k < excess.size(); ++k) change.added.velocity[first + k] += excess[k];
}

template <int D, class Backend>
void OpenBoundaries<D, Backend>::fillReserves(const CellGrid<D>& grid, Change& change) {
  const Particles<D, Backend>& p = state_.particles;
  const std::uint32_t n = p.fluidCount;
  std::vector<ReserveParticle<D>> found = joinedLists(
      state_.context, findReserves<D>(state_.context, state_.openings.span(), p.position.span().first(n),
                                      p.velocity.span().first(n), gone_.span().first(n)));
  std::ranges::stable_sort(found, {}, &ReserveParticle<D>::opening);
  for (std::size_t k = 0; k < state_.faces.size(); ++k) {
    const auto in = std::ranges::equal_range(found, k, {}, &ReserveParticle<D>::opening);
    fillReserve(grid, k, {in.begin(), in.end()}, change);
  }
}

/// Each column goes on behind its last particle to the end of the reserve, with the speed of that particle.
template <int D, class Backend>
void OpenBoundaries<D, Backend>::fillReserve(const CellGrid<D>& grid, std::size_t opening,
                                             std::span<const ReserveParticle<D>> in, Change& change) const {
  const OpeningFace<D>& face = state_.faces[opening];
  std::vector<const ReserveParticle<D>*> last(face.columns());
  for (const ReserveParticle<D>& particle : in)
    face.forEachColumnNear(particle.x, [&](std::uint32_t column) {
      if (!last[column] || last[column]->behind < particle.behind) last[column] = &particle;
    });
  std::vector<Vec<D>> places;
  std::vector<double> speeds;
  for (std::size_t column = 0; column < last.size(); ++column) {
    if (!last[column]) continue;
    for (double behind = last[column]->behind + 1; behind <= face.place().depth; ++behind) {
      places.push_back(face.at(column, behind));
      speeds.push_back(last[column]->speed);
    }
  }
  if (places.empty()) return;
  const Case& c = state_.theCase;
  const Opening& o = c.openings[opening];
  const auto body =
      std::ranges::find_if(c.bodies, [&](const Body& b) { return b.holdsFluid() && b.material == o.material; });
  const Incoming incoming{fmt::format("the reserve of opening '{}'", o.name), o.material,
                          static_cast<std::size_t>(body - c.bodies.begin()), o.temperature, o.viscosityFactor};
  const std::uint32_t first = add(grid, incoming, std::move(places), change.flow.openings[opening].in, change);
  for (std::size_t k = 0; k < speeds.size(); ++k)
    change.added.velocity[first + k] = speeds[k] * face.place().direction;
}

template <int D, class Backend>
std::uint32_t OpenBoundaries<D, Backend>::add(const CellGrid<D>& grid, const Incoming& incoming,
                                              std::vector<Vec<D>> places, FlowCount& count, Change& change) const {
  for (Vec<D>& x : places)
    if (!grid.wrap(x))
      throw RunError(fmt::format("{} is outside the domain at t = {:.6g} s", incoming.source, state_.time));
  if (places.size() > std::numeric_limits<std::uint32_t>::max() - change.flow.nextId)
    throw RunError(fmt::format("more than {} particles have been in the case: there are no numbers left for more",
                               std::numeric_limits<std::uint32_t>::max()));
  Particles<D>& added = change.added;
  const std::uint32_t first = added.fluidCount;
  const Material& material = state_.theCase.materials[static_cast<std::size_t>(incoming.material)];
  const std::vector<double> starts = state_.theCase.startsOfStates(material);
  appendParticles<D>(added, places);
  for (std::uint32_t i = first; i < added.fluidCount; ++i) {
    added.material[i] = static_cast<std::uint8_t>(incoming.material);
    added.body[i] = static_cast<std::uint8_t>(incoming.body);
    added.id[i] = change.flow.nextId++;
    if (added.has.sides) added.side[i] = sides::None;
    if (added.has.temperatures) added.temperature[i] = incoming.temperature;
    if (added.has.viscosityFactors)
      added.viscosityFactor[i] = incoming.viscosityFactor > 0 ? incoming.viscosityFactor : 1;
    for (std::size_t k = 0; k < added.has.elasticModes; ++k)
      added.conformation[k][i] = SymmetricBlock<D>::identity();
    for (std::size_t k = 0; k < added.has.states; ++k) added.states[k][i] = starts[k];
  }
  const double mass = material.density * volume_;
  count += {places.size(), static_cast<double>(places.size()) * mass};
  return first;
}

template <int D, class Backend>
void OpenBoundaries<D, Backend>::measureFriction(StepMethod<D, Backend>& method) {
  if (state_.faces.empty()) return;
  const std::uint32_t n = state_.particles.fluidCount;
  vector_.resize(state_.context, n);
  method.wallFriction(vector_.span());
  drag_.clear();
  for (const OpeningFace<D>& face : state_.faces)
    drag_.push_back(-meanInReserve<D>(state_.context, face.place(), state_.particles.position.span().first(n),
                                      vector_.span()));
}

template <int D, class Backend>
std::span<const Vec<D>> OpenBoundaries<D, Backend>::straightened(std::span<const Vec<D>> u) {
  if (state_.faces.empty()) return u;
  vector_.resize(state_.context, u.size());
  straightenTails<D>(state_.context, state_.openings.span(), state_.particles.position.span().first(u.size()), u,
                     vector_.span());
  return vector_.span();
}

#define TREACLE_INSTANTIATE(Backend)         \
  template class OpenBoundaries<2, Backend>; \
  template class OpenBoundaries<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
