#pragma once

#include "explicit_forces.hpp"
#include "flow/gas_pockets.hpp"
#include "run/selected.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/search/cell_owners.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The gas that the fluid has trapped in a step: its pockets, and their pressures at the end of the step, in which
/// the flow with these pressures leaves them the volume that goes with them. In MPH-I it is one of the explicit
/// forces.
template <int D, class Backend>
class StepGas final : public ExplicitForces<D, Backend> {
 public:
  /// `others`: forces that go with those of the gas in allForces(), or null with ISPH; must outlive this.
  StepGas(const Case& c, const ExplicitForces<D, Backend>* others) : pockets_(c), others_(others) {}

  /// On the places where the forces of the step are. `grid`, `owners`: of the search. Collective.
  void prepare(const FlowState<D, Backend>& state, const CellGrid<D>& grid, const CellOwners<D>& owners) {
    const Particles<D, Backend>& p = state.particles;
    position_.resize(p.count);
    copyToHost(state.context, std::span<const Vec<D>>(p.position), position_.data());
    const bool isAlone = !state.context.communicator;
    if (!isAlone) takeOwn(p, grid, owners);
    gas_ = p.gas;
    isNew_ = pockets_.find(state.context, isAlone ? position_.span() : ownPosition_.span(), p.fluidCount, gas_);
    std::vector<GasContact<D>> contacts(pockets_.contacts().begin(), pockets_.contacts().end());
    if (!isAlone)
      for (GasContact<D>& contact : contacts) contact.particle = own_[contact.particle];
    const auto walls = std::ranges::lower_bound(contacts, p.wallBegin(), {}, &GasContact<D>::particle);
    fromHost(state.context, std::span<const GasContact<D>>(contacts.begin(), walls), ofFluid_);
    fromHost(state.context, std::span<const GasContact<D>>(walls, contacts.end()), ofWalls_);
    if (state.theCase.needsWallNeighbours() || state.theCase.hasLoads()) findSides(state, {walls, contacts.end()});
    pressures_.clear();
    for (const GasState::Pocket& pocket : gas_.pockets) pressures_.push_back(pocket.pressure);
    setPressures(state);
  }

  /// Whether the pockets are other ones than in the step before.
  bool isNew() const { return isNew_; }

  /// y += the forces of the pressures at hand per own fluid particle [N/m3].
  void addPressures(FlowState<D, Backend>& state, std::span<Vec<D>> y) const {
    addGasForces<D>(state.context, ofFluid_.span(), pressure_.span(), particleVolume(state), y);
  }

  /// The pressures at hand around own fluid particles that are near a pocket, 0 elsewhere [Pa].
  std::span<const double> outside(FlowState<D, Backend>& state) {
    outside_.resize(state.context, state.particles.fluidCount);
    clearValues(state.context, outside_.span());
    setOutside<D>(state.context, ofFluid_.span(), pressure_.span(), outside_.span());
    return outside_.span();
  }

  const std::vector<double>& pressures() const { return pressures_; }
  void set(const FlowState<D, Backend>& state, std::span<const double> pressures) {
    pressures_.assign(pressures.begin(), pressures.end());
    setPressures(state);
  }

  /// By how much each pressure is more than what belongs to the volume of the pocket after the flow in
  /// state.velocity [Pa].
  std::vector<double> excess(FlowState<D, Backend>& state) {
    growth_ = growth(state);
    std::vector<double> excess;
    for (std::size_t k = 0; k < pressures_.size(); ++k)
      excess.push_back(pressures_[k] - pockets_.pressure(gas_.pockets[k], gas_.pockets[k].volume + growth_[k]));
    return excess;
  }

  /// The pressures and the growth of the last excess() are those of the step.
  void accept(FlowState<D, Backend>& state) {
    for (std::size_t k = 0; k < gas_.pockets.size(); ++k) {
      gas_.pockets[k].volume += growth_[k];
      gas_.pockets[k].pressure = pressures_[k];
    }
    state.particles.gas = gas_;
  }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const override {
    others_->addForces(state, y);
  }
  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const override {
    others_->allForces(state, pairs, walls, y, load);
    addPressures(state, y);
  }
  void addLoads(std::span<LoadSums> loads) const override {
    if (others_) others_->addLoads(loads);
    for (std::size_t k = 0; k < pressures_.size(); ++k)
      for (std::size_t b = 0; b < loads.size(); ++b) {
        const Side& side = sides_[k * loads.size() + b];
        loads[b].force += pressures_[k] * side.area;
        loads[b].torque += pressures_[k] * side.moment;
      }
  }

  std::size_t bytes() const {
    const std::size_t onHost = std::is_same_v<Backend, Cpu>
                                   ? position_.bytes() + ownPosition_.bytes() + own_.bytes() + pockets_.bytes()
                                   : 0;
    return onHost + ofFluid_.bytes() + ofWalls_.bytes() + outside_.bytes() + pressure_.bytes();
  }

 private:
  /// What a pocket and a body have in common: force and torque about the origin over the pressure.
  struct Side {
    Vec<3> area{}, moment{};  // [m2], [m3]; per metre in 2D
  };

  /// The process's own fluid, and the walls in its cells: of all walls, which every process holds in cases with
  /// gas.
  void takeOwn(const Particles<D, Backend>& p, const CellGrid<D>& grid, const CellOwners<D>& owners) {
    own_ = selected(0, p.count, [&](std::uint32_t i) {
      return i < p.fluidCount || (i >= p.wallBegin() && owners.isOwn(grid.linear(grid.cellOf(position_[i]))));
    });
    ownPosition_.resize(own_.size());
    gather(std::span<const Vec<D>>(position_), own_, ownPosition_.data());
  }

  void findSides(const FlowState<D, Backend>& state, std::span<const GasContact<D>> ofWalls) {
    const std::size_t bodies = state.theCase.bodies.size();
    Buffer<std::uint8_t> body(state.particles.count);
    copyToHost(state.context, std::span<const std::uint8_t>(state.particles.body), body.data());
    sides_.assign(gas_.pockets.size() * bodies, {});
    for (const GasContact<D>& contact : ofWalls) {
      if (body[contact.particle] >= bodies) continue;
      Side& side = sides_[contact.pocket * bodies + body[contact.particle]];
      const Vec<3> area = resized<3>(contact.area);
      side.area += area;
      side.moment += cross(resized<3>(position_[contact.particle]), area);
    }
    static_assert(sizeof(Side) == 6 * sizeof(double));
    sumOverProcesses(state.context, std::span(sides_.empty() ? nullptr : sides_[0].area.v, 6 * sides_.size()));
  }

  static double particleVolume(const FlowState<D, Backend>& state) { return std::pow(state.theCase.spacing, D); }

  void setPressures(const FlowState<D, Backend>& state) {
    fromHost(state.context, std::span<const double>(pressures_), pressure_);
  }

  /// By how much pockets grow in the step, by the motion of fluid and walls.
  std::vector<double> growth(FlowState<D, Backend>& state) const {
    std::vector<double> growth;
    for (std::uint32_t k = 0; k < gas_.pockets.size(); ++k)
      growth.push_back(state.timeStep *
                       (gasRate<D>(state.context, ofFluid_.span(), k, state.velocity.span()) +
                        gasRate<D>(state.context, ofWalls_.span(), k, state.particles.velocity.span())));
    return growth;
  }

  GasPockets<D> pockets_;
  const ExplicitForces<D, Backend>* others_;
  GasState gas_;                   // of the step at hand
  std::vector<double> pressures_;  // that are tried [Pa]
  std::vector<double> growth_;     // with them [m3; m2 in 2D]
  bool isNew_ = false;
  std::vector<Side> sides_;     // of pockets, and of each of them per body of the case; of all processes
  Buffer<Vec<D>> position_;     // of all particles
  Buffer<std::uint32_t> own_;   // where processes share a case: who counts here
  Buffer<Vec<D>> ownPosition_;  // and where they are
  Buffer<GasContact<D>, Backend> ofFluid_, ofWalls_;
  Buffer<double, Backend> outside_;  // outside(), with ISPH
  Buffer<double, Backend> pressure_;
};

}  // namespace treacle
