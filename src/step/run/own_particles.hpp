#pragma once

#include "flow_state.hpp"
#include "selected.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/search/cell_owners.hpp"
#include "treacle/step/walls/distant_walls.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace treacle {

/// Walls that a process holds on the host, with the states that active ones have; the ghosts' have been brought.
template <int D, class Backend>
Particles<D> heldWalls(const FlowState<D, Backend>& state) {
  const Particles<D, Backend>& p = state.particles;
  Particles<D> walls;
  walls.resize({0, p.wallCount(), 0, 0, 0, p.has.ofWalls()});
  forEachSharedFieldOf([&](const auto& from,
                           auto& to) { copyToHost(state.context, from.span().subspan(p.wallBegin()), to.data()); },
                       p, walls);
  std::uint32_t active = state.context.halo->ownWalls;
  for (const auto& neighbour : state.context.halo->neighbours) active += neighbour.walls;
  std::fill(walls.pressure.begin() + active, walls.pressure.end(), 0.0);
  std::fill(walls.numberDensity.begin() + active, walls.numberDensity.end(), 0.0);
  return walls;
}

/// What one of several processes shows of the state they share: its own fluid; as ghosts, with positions alone,
/// the fluid of others next to it; its walls, and then other walls in reach. Its walls are those in its own cells,
/// where they are now, and the distant ones of its part, so that each is one process's. Returns their number.
/// Collective. Errors: std::bad_alloc.
template <int D, class Backend>
std::uint32_t copyOwnParticles(FlowState<D, Backend>& state, const CellGrid<D>& cells, const CellOwners<D>& owners,
                               const DistantWalls<D>& distant, Particles<D>& host) {
  Particles<D, Backend>& p = state.particles;
  fillGhosts(state.context, Held::Fluid, p.position.data());
  fillGhosts(state.context, Held::Active, p.pressure.data());
  fillGhosts(state.context, Held::Active, p.numberDensity.data());
  const Particles<D> walls = heldWalls(state);
  Particles<D> far = distant.ofPart();
  far.has.sides = p.has.sides;  // cases with thin sheets have no distant walls
  const auto cellOf = [&](std::uint32_t i) { return cells.linear(cells.cellOf(walls.position[i])); };
  const auto own = selected(0, walls.count, [&](std::uint32_t i) { return owners.isOwn(cellOf(i)); });
  const auto beside = selected(0, walls.count, [&](std::uint32_t i) { return owners.isBesideOwn(cellOf(i)); });
  ParticleNumbers numbers{p.fluidCount, own.size() + far.count + beside.size()};
  numbers.ghosts = p.ghostCount;
  numbers.has = p.has;
  host.resize(numbers);
  const std::uint32_t begin = p.wallBegin();
  forEachSharedFieldOf(
      [&](const auto& from, const auto& held, const auto& distantOnes, auto& to) {
        copyToHost(state.context, from.span().first(begin), to.data());
        gather(held.span(), own, to.data() + begin);
        std::copy(distantOnes.begin(), distantOnes.end(), to.data() + begin + own.size());
        gather(held.span(), beside, to.data() + begin + own.size() + far.count);
      },
      p, walls, far, host);
  const auto show = [&](bool has, const auto& field, auto& to) {
    if (has) copyToHost(state.context, field.span().first(p.fluidCount), to.data());
  };
  show(p.has.shearRates, p.shearRate, host.shearRate), show(p.has.temperatures, p.temperature, host.temperature);
  show(p.has.viscosityFactors, p.viscosityFactor, host.viscosityFactor);
  for (std::size_t k = 0; k < p.has.states; ++k) show(true, p.states[k], host.states[k]);
  for (std::size_t k = 0; k < p.has.elasticModes; ++k) show(true, p.conformation[k], host.conformation[k]);
  return static_cast<std::uint32_t>(own.size()) + far.count;
}

}  // namespace treacle
