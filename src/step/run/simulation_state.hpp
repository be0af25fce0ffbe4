#pragma once

#include "bodies/moving_bodies.hpp"
#include "flow/open_boundaries.hpp"
#include "give_fluid.hpp"
#include "given_step.hpp"
#include "method/step_motion.hpp"
#include "pressed_steps.hpp"
#include "start_state.hpp"
#include "step_method.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/case/bulk_constants.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/step/readings/diagnostics.hpp"
#include "treacle/step/run/shareable.hpp"
#include "treacle/step/run/simulation.hpp"
#include "treacle/step/run/step_control.hpp"
#include "walls/held_walls.hpp"
#include "walls/step_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace treacle {

/// What a simulation is between its steps, and how it makes one.
template <int D, class Backend>
struct Simulation<D, Backend>::State : FlowState<D, Backend> {
  using Flow = FlowState<D, Backend>;
  using Flow::theCase, Flow::context, Flow::particles, Flow::step, Flow::time, Flow::timeStep, Flow::velocityStep,
      Flow::velocity, Flow::position, Flow::wallsMove, Flow::phases;

  MovingBodies<D, Backend> bodies;
  StepMotion<D, Backend> motion;
  OpenBoundaries<D, Backend> boundaries;
  StepSides<D, Backend> sides;
  std::unique_ptr<StepMethod<D, Backend>> method;
  std::optional<DistantWalls<D>> distant;  // which `particles` has not
  double lastSpeed = 0;                    // of the fastest particle [m/s]
  double turningScale = 0;                 // turningScale(theCase) [m kg^0.5]
  double mass = 0;                         // of the fluid at the start [kg; per metre of depth in 2D]
  std::optional<Watch> watch;
  std::optional<StepControl> control;  // of automatic steps
  double endOfStep = 0;                // time at the end of the step at hand [s]
  bool tooCoarse = false;              // an automatic step was, and it was said
  bool foldsFast = false;              // the fluid did (BulkMemory::turning), and it was said
  PressedSteps pressedSteps;           // among equal ones

  State(const Case& c, Particles<D> state, std::int64_t startStep, double startTime, const Communicator* processes)
      : Flow(c, startStep, startTime), bodies(*this), motion(*this, bodies), boundaries(*this), sides(*this) {
    if (theCase.time.automatic) control.emplace(theCase);
    if (processes && processes->size() > 1) {
      requireShareable(theCase, std::is_same_v<Backend, Cpu> ? BackendKind::Cpu : BackendKind::Cuda);
      this->share(*processes);
    }
    this->fluidOfAll = static_cast<std::uint32_t>(sumOverProcesses(context, state.fluidCount));
    wallsMove = sumOverProcesses(context, someWallMoves(theCase, state)) > 0;
    turningScale = treacle::turningScale(theCase);
    mass = sumOverProcesses(context, fluidMass(theCase, state));
    boundaries.begin(state);
    bodies.begin(state);
    method = theCase.method.kind == MethodKind::Isph ? makeIsphStep(static_cast<Flow&>(*this))
                                                     : makeMphStep(static_cast<Flow&>(*this));
    if (context.communicator) requireCells<D>(theCase, method->grid(), state, *context.communicator);
    distant.emplace(theCase, method->grid(), state, time, context.communicator);
    setExtras(theCase, state);
    toBackend(context, std::move(state), particles);
    if (step == 0) forgetFlow();
    // A state that goes on is in the order that its last step has left it in, which the next one's sort follows.
    if (step == 0 || context.communicator || theCase.middleShare() == 0) method->sortParticles();
    sides.update(*this, time);
    if (step == 0) {  // else the state has the densities of its last step
      method->findNeighbours();
      method->computeDensities();
    }
    startWatch();
  }

  void forgetFlow() {
    forEachFlowMemoryOf([&](auto& field) { clearValues(context, field.span()); }, particles);
    clearValues(context, particles.heldPressure.span());
  }

  /// From the state as it is.
  void startWatch() {
    const Diagnostics start = diagnostics();
    lastSpeed = start.maxSpeed;
    watch.emplace(theCase, start, mass, this->fluidOfAll, wallsMove || theCase.isOpen());
  }

  void requireAlone() const {
    if (context.communicator) throw InputError("processes share the simulation; expected one that is alone");
  }

  /// What the fluid remembers does not lead to a state that somebody else has made.
  void giveFluid(const GivenFluid& given) {
    requireAlone();
    const auto fluid = CheckedFluid<D, Backend>::of(
        context, theCase.method.kind, given, method->grid(), particles,
        [&](std::span<const Vec<D>> u) { return diagnosticsOf(particles.position, u).kineticEnergy; });
    if (fluid.viscosityFactor.size() > 0 && !particles.has.viscosityFactors) {
      haveViscosityFactors<D, Backend>(*this);
      method = makeMphStep(static_cast<Flow&>(*this));  // of another kind
    }
    fluid.copyTo(context, particles);
    particles.modes.pressure = {};  // the solver's, of viscosities, too
    if (fluid.position.size() == 0 && fluid.velocity.size() == 0) return;
    forgetFlow();
    particles.steps = {};
    if (fluid.position.size() > 0) {
      particles.modes.drop();
      distant->addStep(0, std::numeric_limits<double>::infinity());  // who knows how far they have gone
    }
    startWatch();
  }

  void giveMotion(std::size_t body, const Body& as) {
    requireAlone();
    theCase.bodies[body] = as;
    if (auto& nozzle = this->nozzles[body]) nozzle.emplace(theCase, as);
  }

  void chooseTimeStep() {
    const double fastest = std::max(lastSpeed, bodies.expectedSpeed());
    const StepControl::Step next =
        control ? control->next(particles.steps, time, fastest) : givenStep(theCase, step, time, fastest);
    timeStep = next.length, endOfStep = next.end;
    // Velocities belong to the middles of steps where forces do.
    velocityStep = theCase.middleShare() > 0 ? 0.5 * (this->lastStep() + timeStep) : timeStep;
    this->setFrame();
  }

  /// Where forces belong to the middle of the step at hand, all particles go there.
  void goToMiddle() {
    const double share = theCase.middleShare();
    if (share > 0) motion.goTo(method->grid(), *watch, share * timeStep);
  }

  void accept() {
    method->accept();
    copyValues(context, std::span<const Vec<D>>(velocity).first(particles.fluidCount), particles.velocity.data());
    motion.accept();
    distant->addStep(timeStep, std::max(method->longestWay(lastSpeed), timeStep * bodies.freeSpeed()));
    bodies.accept();
    ++step;
    time = endOfStep;
    particles.steps.last = timeStep;
  }

  Diagnostics diagnostics() const { return diagnosticsOf(particles.position, particles.velocity); }
  Diagnostics diagnosticsOf(std::span<const Vec<D>> x, std::span<const Vec<D>> u) const {
    const std::uint32_t n = particles.fluidCount;
    DiagnosticsInput<D> in;
    in.position = x.first(n);
    in.velocity = u.first(n);
    in.material = particles.material.span().first(n);
    in.materials = method->materials();
    in.frame = this->frame;
    in.spacing = theCase.spacing;
    method->describe(in);
    return computeDiagnostics<D>(context, in);
  }

  /// Leaves the velocities at the end of a step of timeStep in `velocity`.
  StagedReport solve() {
    StagedReport solved = method->predict();
    phases.run(context, treacle::phases::coefficients, [&] { method->prepareSystem(); });
    phases.run(context, treacle::phases::coarse, [&] { method->preparePreconditioner(); });
    phases.run(context, treacle::phases::solve, [&] { solved.follow(method->solve()); });
    return solved;
  }

  /// The same for a step that is as short as the tolerance of automatic steps wants it. What is not accepted has
  /// changed nothing but the memories of solver and steps.
  StagedReport solveExactly(StepReport& report) {
    StagedReport solved;
    while (!(trySolve(solved) && isExact(report))) {
      ++report.rejected;
      particles.modes.pressure = {};  // of steps of that length
      motion.goBack();
      chooseTimeStep();
      if (theCase.middleShare() > 0)
        arrange();
      else
        bodies.prepare();
    }
    return solved;
  }

  /// What cannot be solved may be so with a shorter step.
  bool trySolve(StagedReport& solved) {
    try {
      solved.follow(solve());
    } catch (const RunError&) {
      if (!control->shorten(timeStep, particles.steps)) throw;
      return false;
    }
    return true;
  }

  bool isExact(StepReport& report) {
    double way = 0;
    phases.run(context, treacle::phases::update, [&] {
      const std::uint32_t n = particles.fluidCount;
      const StepChangeTerms<D> terms{particles.velocity.span().first(n), velocity.span().first(n)};
      const StepChange is = stepChange<D>(context, terms);
      report.error = control->error(is, timeStep, particles.steps);
      if (control->flows(is.speed, timeStep)) way = method->pressedWay();
    });
    if (!control->accept(timeStep, report.error, way, particles.steps)) return false;
    const TimeSettings& t = theCase.time;
    if (report.error > t.tolerance && !std::exchange(tooCoarse, true))
      report.warnings.push_back(fmt::format(
          "the error of a step of {:.3g} s is {:.2g}, more than time.tolerance = {:g}, but the step cannot be "
          "shorter: time.min_step is {:.3g} s{}; further ones are not reported",
          timeStep, report.error, t.tolerance, t.least,
          t.least == defaultLeastStep(t) ? fmt::format(", by default a 10,000th of max_step = {:.3g} s", t.step)
                                         : ""));
    return true;
  }

  /// Particles to where their forces are in the step at hand, and in order there.
  void arrange() {
    phases.run(context, treacle::phases::search, [&] {
      goToMiddle();
      bodies.prepare();
      method->sortParticles();
      sides.update(*this, time + theCase.middleShare() * timeStep);
    });
    phases.run(context, treacle::phases::lists, [&] { method->findNeighbours(); });
  }

  void begin() {
    chooseTimeStep();
    phases.start(context);
    phases.run(context, treacle::phases::search, [&] {
      const double early = theCase.middleShare() * timeStep;
      if (distant->isDue(early, early * std::max(lastSpeed, bodies.freeSpeed())))
        holdNearWalls(*this, method->grid(), *distant);
    });
    arrange();
  }

  StepReport advance() {
    try {
      return advanceOrFail();
    } catch (const DeviceFailure&) {
      throw;  // nothing on it is trusted
    } catch (...) {
      motion.goBack();
      throw;
    }
  }

  StepReport advanceOrFail() {
    StepReport report;
    begin();
    StagedReport solved = control ? solveExactly(report) : solve();
    phases.run(context, treacle::phases::update, [&] {
      method->correctVelocities();
      boundaries.measureFriction(*method);
      motion.move(method->grid(), *watch, timeStep, boundaries.straightened(method->transportVelocities()),
                  this->rigid.bodies);
      report.diagnostics = diagnosticsOf(position, velocity);
      report.watched = watch->look(timeStep, report.diagnostics, report.warnings);
      lastSpeed = report.diagnostics.maxSpeed;
      const double start = time;
      accept();
      if (!control) pressedSteps.look(theCase, method->pressedWay(), lastSpeed, report.warnings);
      if (theCase.keepsVolume() && !theCase.hasVolumeFactors()) adaptBulk(report);
      if (theCase.isOpen()) report.flow = followFlow(start);
    });
    report.seconds = phases.seconds();
    report.step = step;
    report.time = time;
    report.timeStep = timeStep;
    report.velocityStep = velocityStep;
    report.iterations = solved.iterations;
    report.residual = solved.residual;
    report.fallbacks = solved.fallbacks;
    report.failures = std::move(solved.failures);
    report.balance = method->balance();
    report.loads = method->loads();
    report.patches = method->patchPressures();
    report.rigid = particles.rigid.bodies;
    if (theCase.gas) report.gas = gasReport();
    return report;
  }

  void adaptBulk(StepReport& report) {
    const Diagnostics& d = report.diagnostics;
    if (!watch->tellsDensity(d)) return;
    BulkMemory& bulk = particles.bulk;
    const BulkMemory before = bulk;
    const double turning = turningScale > 0 ? std::sqrt(2 * d.kineticEnergy / this->fluidOfAll) / turningScale : 0;
    const FluidDensity is{d.meanDensityRatio - 1, d.compression, turning};
    if (!adaptBulkConstants(theCase, is, timeStep, step == 1, bulk)) return;
    particles.modes.pressure = {};
    const bool folds = bulk.turning > before.turning;
    if (bulk.turning < before.turning || (folds && std::exchange(foldsFast, true))) return;
    const double percent = 100 * is.excess;
    if (folds)
      report.notes.push_back(
          fmt::format("the fluid is {:.2g} % too dense: its automatic bulk modulus is {:.3g} "
                      "times as large as at first while it flows as fast",
                      percent, bulk.modulusOfAll()));
    else
      report.notes.push_back(
          fmt::format("the fluid is {:.2g} % too dense: its automatic bulk modulus is {:.3g} times, its bulk "
                      "viscosity {:g} times as large as at first from here on",
                      percent, bulk.modulusOfAll(), bulk.viscosity));
  }

  GasReport gasReport() const {
    GasReport report;
    double largest = 0;
    for (const GasState::Pocket& pocket : particles.gas.pockets) {
      ++report.pockets;
      report.volume += pocket.volume;
      if (pocket.volume > largest) largest = pocket.volume, report.pressure = pocket.pressure;
    }
    return report;
  }

  FlowReport followFlow(double start) {
    DiagnosticsInput<D> in;
    method->describe(in);
    if (boundaries.follow(method->grid(), start, in.restDensity > 0 ? in.restDensity : 1)) {
      method->sortParticles();
      watch->setParticles(this->fluidOfAll);
    }
    return {this->fluidOfAll, particles.flow.in(), particles.flow.out()};
  }

  std::vector<SolverTrial> convergence(std::span<const SolverSettings> solvers) {
    begin();
    method->predict();
    method->prepareSystem();
    std::vector<SolverTrial> trials;
    for (const SolverSettings& solver : solvers) trials.push_back(method->solveBy(solver));
    motion.goBack();
    return trials;
  }

  std::size_t bytes() const {
    std::size_t sum = velocity.bytes() + position.bytes() + this->wallMotion.bytes() + this->openings.bytes() +
                      bodies.bytes() + boundaries.bytes() + sides.bytes() + method->bytes();
    particles.forEachField([&](const auto& field) { sum += field.bytes(); });
    if (!particles.has.starts) sum += particles.start.bytes();
    return std::is_same_v<Backend, Cpu> ? sum + distant->bytes() : sum;
  }
};

}  // namespace treacle
