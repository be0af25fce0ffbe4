#pragma once

#include "run/flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "wall_loads.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// What walls bear of the fluid in a step of ISPH, and holds what that takes.
template <int D, class Backend>
class IsphWallForces {
 public:
  /// Room for what the corrector tells of fluid that walls stop (CorrectorTerm).
  Vec<D>* prepare(FlowState<D, Backend>& state, const IsphPairs<D>& pairs) {
    stopped_.resize(state.context, pairs.fluidCount);
    return stopped_.data();
  }

  /// Per body of the case, of all processes, after the corrector [N], [N m] and [W]; in 2D per metre of depth.
  /// `pressure`, with ghosts, `velocity`, that the viscous step has taken its forces of, and `flow`
  /// (WallForceTerm) are those of the step; `viscous`: there is one.
  std::vector<LoadSums> loads(FlowState<D, Backend>& state, const IsphPairs<D>& pairs,
                              std::span<const double> pressure, std::span<const Vec<D>> velocity, bool viscous,
                              const SmoothFlow<D>* flow) {
    const auto& rows = pairs.fluidOfWalls;
    fillGhosts(state.context, Held::Fluid, stopped_.data());
    force_.resize(state.context, rows.count);
    couple_.resize(state.context, rows.count);
    const WallForceTerm<D> term{pressure.data(), velocity.data(), stopped_.data(), viscous,
                                rows.first,      force_.data(),   couple_.data(),  flow};
    sumOnWalls(state.context, pairs, term);
    return loadsOfBodies<D, Backend>(state, rows.first, pairs.position, state.particles.velocity, force_, couple_);
  }

  /// On patches of walls, after loads().
  std::vector<double> pressures(FlowState<D, Backend>& state, const IsphPairs<D>& pairs) {
    return patchPressures<D, Backend>(state, pairs.fluidOfWalls.first, pairs.position, force_);
  }

  std::size_t bytes() const { return stopped_.bytes() + force_.bytes() + couple_.bytes(); }

 private:
  Buffer<Vec<D>, Backend> stopped_;  // of CorrectorTerm, with ghosts; empty where nobody asks for forces
  Buffer<Vec<D>, Backend> force_;    // per own active wall particle, likewise [N/m3]
  Buffer<Vec<3>, Backend> couple_;   // likewise [N/m2]
};

}  // namespace treacle
