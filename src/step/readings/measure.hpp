#pragma once

#include "run/flow_state.hpp"
#include "run/gather_particles.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/motion/carried_probe.hpp"
#include "treacle/search/near_places.hpp"
#include "treacle/step/readings/probe_reading.hpp"
#include "treacle/step/readings/probe_sums.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace treacle {

/// The particles of all processes, at the first one. Collective.
template <int D>
Particles<D> collected(const Communicator& processes, const Particles<D>& own) {
  std::array<std::uint64_t, 2> numbers{own.fluidCount, own.wallCount()};
  processes.sum(std::span<std::uint64_t>(numbers));
  Particles<D> all;
  if (processes.rank() == 0) all.resize(numbersOfSome(own, numbers[0], numbers[1]));
  all.has = own.has;
  const auto collect = [&]<class T>(std::span<const T> part, T* to) { collectTo(processes, part, to); };
  forEachSharedFieldOf(
      [&](const auto& from, auto& to) {
        collect(from.span().first(own.fluidCount), to.data());
        collect(from.span().subspan(own.wallBegin()), to.data() + all.wallBegin());
      },
      own, all);
  forEachFluidFieldOf([&](const auto& from, auto& to) { collect(from.span(), to.data()); }, own, all);
  return all;
}

/// The particles of all processes around the places of a probe, at the first one. Collective.
template <int D, class Backend>
Particles<D> particlesNear(const FlowState<D, Backend>& state, const Probe& probe) {
  const Case& c = state.theCase;
  const auto near = Surroundings<D>::of(ProbePlaces::of(probe, c.spacing), probeReach * c.spacing, c.domain);
  const Communicator* processes = state.context.communicator;
  Particles<D> own;
  copyNear<D>(state.context, near, state.particles,
              processes ? state.context.halo->ownWalls : state.particles.wallCount(), own);
  return processes ? collected(*processes, own) : std::move(own);
}

/// What a probe counts, as a test of particles; their fields come with the state. `steps`: takes the formulas of
/// materials.
template <int D, class Backend>
PartTerms<D> partTerms(const FlowState<D, Backend>& state, const Probe& probe,
                       Buffer<FormulaStep, Backend>& steps) {
  const Case& c = state.theCase;
  const Particles<D, Backend>& p = state.particles;
  const std::uint32_t n = p.fluidCount;
  PartTerms<D> terms{};
  terms.weight = PartWeight<D>::of(probe, c);
  std::vector<FormulaStep> formulas;
  terms.viscosities = RheologyTable::make(c, formulas);
  terms.viscosities.read(p, n, state.time);
  if (!formulas.empty()) {
    fromHost(state.context, std::span<const FormulaStep>(formulas), steps);
    terms.viscosities.states.steps = steps.data();
  }
  terms.volume = std::pow(c.spacing, D);  // [K23 eq. (11)]
  for (std::size_t m = 0; m < c.materials.size(); ++m) terms.density[m] = c.materials[m].density;
  terms.position = p.position.span().first(n), terms.velocity = p.velocity.span().first(n);
  terms.pressure = p.pressure.span().first(n), terms.material = p.material.span().first(n);
  if (p.has.shearRates) terms.shearRate = p.shearRate.span().first(n);
  if (p.has.temperatures) terms.temperature = p.temperature.span().first(n);
  return terms;
}

/// What the probes whose bits are set find, but for loads. Collective. Errors: std::bad_alloc.
template <int D, class Backend>
std::vector<ProbeReading> measure(const FlowState<D, Backend>& state, std::uint64_t probes) {
  std::vector<ProbeReading> readings;
  Buffer<FormulaStep, Backend> formulas;
  for (std::size_t k = 0; k < state.theCase.probes.size(); ++k) {
    if ((probes >> k & 1) == 0) continue;
    const Probe probe = carriedProbe(state.theCase.probes[k], state.theCase, state.rigid.bodies, state.time);
    ProbeReading reading{k, probe};
    if (probe.isSummed()) reading.sums = sumPart<D>(state.context, partTerms(state, probe, formulas));
    if (probe.isSampled()) reading.particles = particlesNear(state, probe);
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace treacle
