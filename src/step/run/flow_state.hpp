#pragma once

#include "step_phases.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/device_link.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/model/motion/nozzle.hpp"
#include "treacle/model/motion/opening.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/particles/particles.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

/// The state of a simulation and what a step makes of it, the same for all methods.
template <int D, class Backend>
struct FlowState {
  Case theCase;
  std::int64_t step;    // steps done
  double time;          // [s]
  double timeStep;      // of the step at hand, or the last one [s]
  double velocityStep;  // over which velocities change in it [s]
  FrameForce<D> frame;  // in the step at hand
  bool wallsMove = false;
  std::uint32_t fluidOfAll = 0;  // number of fluid particles, those of all processes

  mutable Context<Backend> context;
  std::unique_ptr<DeviceLink> link;  // of the context, where processes share devices
  Particles<D, Backend> particles;
  // Where the walls of rigid bodies are in the step at hand, with the velocities that are tried for it; empty
  // where the case has none.
  RigidMotion rigid;
  std::vector<std::optional<NozzleLayers<D>>> nozzles;  // per body, of those that are inflows
  std::vector<OpeningFace<D>> faces;                    // per opening
  std::vector<OpeningForce<D>> openingForces;           // likewise; of the step at hand
  Buffer<OpeningForce<D>, Backend> openings;
  Buffer<Vec<D>, Backend> nozzleColumns;       // of the nozzle at hand, NozzleColumns::each
  Buffer<WallMotion<D>, Backend> wallMotion;   // per body, where walls are; empty: all keep their velocities
  Buffer<Vec<D>, Backend> velocity, position;  // the step's results before they are accepted

  StepPhases<Backend> phases;  // of the step at hand

  FlowState(const Case& c, std::int64_t startStep, double startTime)
      : theCase(c),
        step(startStep),
        time(startTime),
        timeStep(c.time.step),
        velocityStep(c.time.step),
        frame(FrameForce<D>::of(c, startTime, startTime)) {
    for (const Body& body : theCase.bodies) {
      nozzles.emplace_back();
      if (body.kind == BodyKind::Inflow) nozzles.back().emplace(theCase, body);
    }
    for (const Opening& opening : theCase.openings) faces.emplace_back(theCase, opening);
  }

  /// What acts on the fluid in the step at hand. Errors: InputError for a formula without a value.
  void setFrame() {
    const auto [from, to] = velocityInterval();
    if (theCase.gravityVaries()) theCase.gravity = theCase.meanGravity(from, to);
    frame = FrameForce<D>::of(theCase, from, to);
    if (faces.empty()) return;
    openingForces.clear();
    for (const OpeningFace<D>& face : faces) {
      const OpenFlow::Opening& before = particles.flow.openings[openingForces.size()];
      openingForces.push_back(face.force(from, to));
      openingForces.back().drag = before.drag;
      if (face.hasFlowRate()) openingForces.back().pressure = before.pressure;
    }
    takeOpenings();
  }
  /// Those in openingForces.
  void takeOpenings() {
    fromHost(context, std::span<const OpeningForce<D>>(openingForces), openings);
    frame.openings = openings.span();
  }

  /// The columns of the nozzle of a body at time t [s], each with its multiple of a vector, until the next call.
  NozzleColumns<D> columnsOf(std::size_t body, double t, std::span<const double> multiples, const Vec<D>& of) {
    const NozzleLayers<D>& nozzle = *nozzles[body];
    fromHost(context, std::span<const Vec<D>>(nozzle.eachOf(multiples, of)), nozzleColumns);
    NozzleColumns<D> columns = nozzle.columns(theCase.domain, t);
    columns.body = static_cast<std::uint8_t>(body);
    columns.each = nozzleColumns.span();
    return columns;
  }

  /// With the others of these processes.
  void share(const Communicator& processes) {
    context.communicator = &processes;
    if constexpr (std::is_same_v<Backend, Cuda>) {
      link = DeviceLink::make(processes, context);
      context.link = link.get();
    }
  }

  /// From when to when velocities change in the step at hand [s]: they belong to the middles of steps where forces
  /// do, else to their ends.
  std::pair<double, double> velocityInterval() const {
    const double to = time + (theCase.middleShare() > 0 ? 0.5 : 1) * timeStep;
    return {to - velocityStep, to};
  }

  /// The step before that at hand; as long as this one where that is not known [s].
  double lastStep() const { return particles.steps.last > 0 ? particles.steps.last : timeStep; }
};

}  // namespace treacle
