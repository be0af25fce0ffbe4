#pragma once

#include "run/flow_state.hpp"
#include "treacle/model/motion/carried_probe.hpp"
#include "treacle/model/state/balance.hpp"
#include "treacle/step/readings/balance_sums.hpp"
#include "treacle/step/readings/wall_patch.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// What each body of the case bears of forces on own active walls, which begin at particle `first` [N/m3]; by all
/// processes, in 2D per metre of depth. `position`, `velocity`: of all particles. `couple`: on these walls beside
/// the forces [N/m2], or empty. Collective.
template <int D, class Backend>
std::vector<LoadSums> loadsOfBodies(FlowState<D, Backend>& state, std::uint32_t first,
                                    std::span<const Vec<D>> position, std::span<const Vec<D>> velocity,
                                    std::span<const Vec<D>> force, std::span<const Vec<3>> couple) {
  const std::size_t walls = force.size();
  const LoadTerms<D> terms{state.particles.body.span().subspan(first, walls),
                           position.subspan(first, walls),
                           velocity.subspan(first, walls),
                           force,
                           couple,
                           state.wallMotion};
  std::vector<LoadSums> loads = sumLoads<D>(state.context, terms, state.theCase.bodies.size());
  const double volume = std::pow(state.theCase.spacing, D);  // [K23 eq. (11)]
  for (LoadSums& load : loads) load = {volume * load.force, volume * load.torque, volume * load.power};
  return loads;
}

/// The pressure on the patch of each probe WallPressure, in the order of the case [Pa]; arguments as above.
/// Collective.
template <int D, class Backend>
std::vector<double> patchPressures(FlowState<D, Backend>& state, std::uint32_t first,
                                   std::span<const Vec<D>> position, std::span<const Vec<D>> force) {
  const std::size_t walls = force.size();
  std::vector<double> pressures;
  for (const Probe& probe : state.theCase.probes) {
    if (probe.kind != ProbeKind::WallPressure) continue;
    const Probe now = carriedProbe(probe, state.theCase, state.rigid.bodies, state.time);
    pressures.push_back(patchPressure<D>(
        state.context,
        PatchTerms<D>{WallPatch<D>::of(now, state.theCase), state.particles.body.span().subspan(first, walls),
                      position.subspan(first, walls), force}));
  }
  return pressures;
}

/// The loads of walls in the order of the case, with torques about their centres.
template <int D, class Backend>
std::vector<WallLoad> wallLoads(const FlowState<D, Backend>& state, const std::vector<LoadSums>& loads) {
  std::vector<WallLoad> walls;
  for (std::size_t b = 0; b < loads.size(); ++b) {
    const Body& body = state.theCase.bodies[b];
    if (!body.isWall()) continue;
    const Vec<3> center =
        body.kind == BodyKind::Rigid ? state.rigid.bodies[b].center : wallCenter(body, state.time);
    walls.push_back({loads[b].force, loads[b].torque - cross(center, loads[b].force), loads[b].power});
  }
  return walls;
}

}  // namespace treacle
