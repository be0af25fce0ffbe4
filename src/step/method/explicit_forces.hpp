#pragma once

#include "run/flow_state.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/step/readings/balance_sums.hpp"

#include <span>

namespace treacle {

/// Forces of a step of MPH-I that follow from places alone, beside elastic pressures: those of surface tension and
/// of the tension of the fluid.
template <int D, class Backend>
class ExplicitForces {
 public:
  virtual ~ExplicitForces() = default;

  /// y += the forces per own fluid particle [N/m3].
  virtual void addForces(FlowState<D, Backend>&, std::span<Vec<D>> y) const = 0;

  /// Sets y to the forces on own fluid particles and, from the place of the first wall particle on, on those of
  /// `walls`, which are added to `load` [N/m3]. Of cases with a balance or rigid bodies.
  virtual void allForces(FlowState<D, Backend>&, const MphPairs<D>&, const ClusterListView& walls,
                         std::span<Vec<D>> y, std::span<Vec<D>> load) const = 0;

  /// Of the last allForces(): the couples that act on walls beside these forces, from the first wall particle on
  /// [N/m2], or nothing.
  virtual std::span<const Vec<3>> couples() const { return {}; }

  /// Adds forces and torques on bodies of the case that are in no pair of particles [N], [N m]; in 2D per metre.
  virtual void addLoads(std::span<LoadSums>) const {}
};

}  // namespace treacle
