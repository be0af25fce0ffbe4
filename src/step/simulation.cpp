#include "treacle/step/simulation.hpp"

#include "failure.hpp"
#include "gather_particles.hpp"
#include "step_method.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/core/team.hpp"
#include "treacle/model/particles_copy.hpp"
#include "treacle/step/diagnostics.hpp"
#include "treacle/step/distant_walls.hpp"
#include "treacle/step/move_particles.hpp"
#include "treacle/step/shareable.hpp"
#include "treacle/step/step_control.hpp"
#include "treacle/step/wall_motion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace treacle {
namespace {

template <int D>
void toBackend(Context<Cpu>&, Particles<D> host, Particles<D>& particles) {
  particles = std::move(host);
}
template <int D>
void toBackend(Context<Cuda>& context, const Particles<D>& host, Particles<D, Cuda>& particles) {
  copyToDevice(context, host, particles);
}

bool someWallOscillates(const Case& c) {
  return std::ranges::any_of(c.bodies, [](const Body& b) { return b.oscillation.period > 0; });
}
bool someWallRotates(const Case& c) {
  return std::ranges::any_of(c.bodies, [](const Body& b) { return b.rotation.has_value(); });
}

/// Of the fluid [kg; per metre of depth in 2D].
template <int D>
double fluidMass(const Case& c, const Particles<D>& particles) {
  double density = 0;
  for (std::uint32_t i = 0; i < particles.fluidCount; ++i) density += c.materials[particles.material[i]].density;
  return density * std::pow(c.spacing, D);
}

template <int D>
bool someWallMoves(const Particles<D>& particles) {
  for (std::uint32_t i = particles.fluidCount; i < particles.count; ++i)
    if (norm2(particles.velocity[i]) > 0) return true;
  return false;
}

/// Loops of the host have a team.
template <class Backend, class F>
void withTeam(F&& body) {
  if constexpr (std::is_same_v<Backend, Cpu>)
    Team::lead(body);
  else
    body();
}

}  // namespace

template <int D, class Backend>
struct Simulation<D, Backend>::State : FlowState<D, Backend> {
  using Flow = FlowState<D, Backend>;
  using Flow::theCase, Flow::context, Flow::particles, Flow::step, Flow::time, Flow::timeStep, Flow::velocity,
      Flow::position, Flow::wallsMove, Flow::phases;

  bool wallsRotate, wallVelocitiesChange;
  Buffer<Vec<D>, Backend> wallChord;  // per wall particle, where some rotate [m/s]
  std::unique_ptr<StepMethod<D, Backend>> method;
  std::optional<DistantWalls<D>> distant;  // which `particles` has not
  double lastSpeed = 0;                    // of the fastest particle [m/s]
  std::optional<Watch> watch;
  std::optional<StepControl> control;  // of automatic steps
  double endOfStep = 0;                // time at the end of the step at hand [s]
  bool tooCoarse = false;              // an automatic step was, and it was said

  State(const Case& c, Particles<D> state, std::int64_t startStep, double startTime, const Communicator* processes)
      : Flow(c, startStep, startTime),
        wallsRotate(someWallRotates(c)),
        wallVelocitiesChange(wallsRotate || someWallOscillates(c)) {
    if (theCase.time.automatic) control.emplace(theCase);
    if (processes && processes->size() > 1) {
      requireShareable(theCase, std::is_same_v<Backend, Cpu> ? BackendKind::Cpu : BackendKind::Cuda);
      context.communicator = processes;
    }
    this->fluidOfAll = state.fluidCount;
    wallsMove = wallVelocitiesChange || someWallMoves(state);
    const double mass = fluidMass(theCase, state);
    method = theCase.method.kind == MethodKind::Isph ? makeIsphStep(static_cast<Flow&>(*this))
                                                     : makeMphStep(static_cast<Flow&>(*this));
    distant.emplace(theCase, method->grid(), state, time);
    toBackend(context, std::move(state), particles);
    if (step == 0) forEachFluidFieldOf([&](auto& field) { clearValues(context, field.span()); }, particles);
    method->sortParticles();
    if (step == 0) {  // else the state has the densities of its last step
      method->findNeighbours();
      method->computeDensities();
    }
    const Diagnostics start = diagnostics();
    lastSpeed = start.maxSpeed;
    watch.emplace(theCase, start, mass, this->fluidOfAll, wallsMove);
  }

  /// Of the walls those that are near something that moves, where that may be others than before.
  void chooseWalls() {
    if (!distant->isDue()) return;
    Particles<D> walls;
    copyWallsToHost(context, particles, walls);
    NearBlocks<D> near(theCase, method->grid());
    near.addMovingWalls(walls);
    addFluidTo(near);
    if (context.communicator) near.unite(*context.communicator);
    if (distant->differs(near)) replaceWalls(context, distant->held(near, walls), particles);
    distant->accept(std::move(near));
  }

  /// Piece by piece: the host need not have room for all places.
  void addFluidTo(NearBlocks<D>& near) {
    constexpr std::size_t piece = std::size_t{1} << 20;
    const std::span<const Vec<D>> x = particles.position.span().first(particles.fluidCount);
    Buffer<Vec<D>> some;
    for (std::size_t first = 0; first < x.size(); first += piece) {
      some.resize(std::min(piece, x.size() - first));
      copyToHost(context, x.subspan(first, some.size()), some.data());
      near.addMoving(some);
    }
  }

  void chooseTimeStep() {
    if (control) {
      const StepControl::Step next = control->next(particles.steps, time, lastSpeed);
      timeStep = next.length, endOfStep = next.end;
    } else if (theCase.time.courant > 0) {
      timeStep = courantStep();
      endOfStep = time + timeStep;
    } else {
      endOfStep = static_cast<double>(step + 1) * timeStep;
    }
  }

  /// No particle goes farther than so many spacings, and the last step meets the end.
  double courantStep() const {
    const TimeSettings& t = theCase.time;
    double length = t.step;
    if (lastSpeed * length > t.courant * theCase.spacing) length = t.courant * theCase.spacing / lastSpeed;
    // Fractions of the time's own rounding would never reach the end.
    if (time + 1e-3 * length == time)
      throw RunError(
          fmt::format("particles at {:.4g} m/s allow steps of {:.3g} s only (time.courant): the time no "
                      "longer advances",
                      lastSpeed, length));
    const double rest = t.end - time;
    return rest > 0 && length > rest * (1 - 1e-9) ? rest : length;
  }

  MovingWalls<D> walls() const {
    const std::uint32_t n = particles.wallBegin();
    return {this->wallMotion, particles.body.span().subspan(n), particles.position.span().subspan(n)};
  }

  /// Motions and velocities of walls that oscillate or rotate, for the step at hand.
  void moveBodies() {
    if (!wallVelocitiesChange) return;
    std::vector<WallMotion<D>> motion;
    for (const Body& body : theCase.bodies)
      motion.push_back(treacle::wallMotion<D>(theCase.domain, body, time, timeStep));
    fromHost(context, std::span<const WallMotion<D>>(motion), this->wallMotion);
    setWallVelocities<D>(context, walls(), particles.velocity.span().subspan(particles.wallBegin()));
  }

  /// What the walls move with.
  std::span<const Vec<D>> wallTransport() {
    if (!wallsRotate) return particles.velocity.span().subspan(particles.wallBegin());
    wallChord.resize(context, particles.wallCount());
    setWallChords<D>(context, walls(), wallChord);
    return wallChord.span();
  }

  /// x^{k+1} of [K23 eq. (15)] into `position`; walls by their prescribed motion.
  void move() {
    position.resize(context, wallsMove ? particles.count : particles.fluidCount);
    agreed(context, [&] {
      moveRange(0, particles.fluidCount, method->transportVelocities());
      if (wallsMove) moveRange(particles.wallBegin(), particles.count, wallTransport());
    });
  }

  /// `u`: of the particles from `begin` on.
  void moveRange(std::uint32_t begin, std::uint32_t end, std::span<const Vec<D>> u) {
    const std::span<const Vec<D>> x = particles.position;
    const std::uint32_t size = end - begin;
    const std::uint32_t out = moveParticles<D>(context, method->grid(), timeStep, x.subspan(begin, size),
                                               u.first(size), position.span().subspan(begin, size));
    if (out == noParticle) return;
    Particles<D> host;
    copyToHost(context, particles, host);
    Vec<D> uOut{};
    copyToHost(context, u.subspan(out, 1), &uOut);
    watch->requireSlow(timeStep, norm(uOut));  // then it is not the domain that is too small
    throw RunError(describeLeaving<D>(host, begin + out, uOut, timeStep));
  }

  void accept() {
    const std::uint32_t walls = particles.wallBegin();
    const std::span<const Vec<D>> moved = position;
    method->accept();
    copyValues(context, std::span<const Vec<D>>(velocity).first(particles.fluidCount), particles.velocity.data());
    copyValues(context, moved.first(particles.fluidCount), particles.position.data());
    if (wallsMove) copyValues(context, moved.subspan(walls), particles.position.data() + walls);
    distant->addStep(timeStep, method->longestWay(lastSpeed));
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
    in.gravity = resized<D>(theCase.gravity);
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
      chooseTimeStep();
      moveBodies();
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
    phases.run(context, treacle::phases::update, [&] {
      const std::uint32_t n = particles.fluidCount;
      const auto change = stepChange<D>(context, {particles.velocity.span().first(n), velocity.span().first(n)});
      report.error = control->error(change, timeStep, particles.steps);
    });
    if (!control->accept(timeStep, report.error, particles.steps)) return false;
    const double most = theCase.time.tolerance;
    if (report.error > most && !std::exchange(tooCoarse, true))
      report.warnings.push_back(fmt::format(
          "the error of a step of {:.3g} s is {:.2g}, more than time.tolerance = {:g}, but the step cannot be "
          "shorter (time.min_step); further ones are not reported",
          timeStep, report.error, most));
    return true;
  }

  StepReport advance() {
    StepReport report;
    chooseTimeStep();
    moveBodies();
    phases.start(context);
    phases.run(context, treacle::phases::search, [&] {
      chooseWalls();
      method->sortParticles();
    });
    phases.run(context, treacle::phases::lists, [&] { method->findNeighbours(); });
    StagedReport solved = control ? solveExactly(report) : solve();
    phases.run(context, treacle::phases::update, [&] {
      method->correctVelocities();
      move();
      report.diagnostics = diagnosticsOf(position, velocity);
      report.watched = watch->look(timeStep, report.diagnostics, report.warnings);
      lastSpeed = report.diagnostics.maxSpeed;
      accept();
    });
    report.seconds = phases.seconds();
    report.step = step;
    report.time = time;
    report.timeStep = timeStep;
    report.iterations = solved.iterations;
    report.residual = solved.residual;
    report.fallbacks = solved.fallbacks;
    report.failures = std::move(solved.failures);
    report.balance = method->balance();
    return report;
  }

  std::vector<SolverTrial> convergence(std::span<const SolverSettings> solvers) {
    chooseTimeStep();
    moveBodies();
    phases.start(context);
    chooseWalls();
    method->sortParticles();
    method->findNeighbours();
    method->predict();
    method->prepareSystem();
    std::vector<SolverTrial> trials;
    for (const SolverSettings& solver : solvers) trials.push_back(method->solveBy(solver));
    return trials;
  }

  std::size_t bytes() const {
    std::size_t sum = velocity.bytes() + position.bytes() + wallChord.bytes() + method->bytes();
    particles.forEachField([&](const auto& field) { sum += field.bytes(); });
    return std::is_same_v<Backend, Cpu> ? sum + distant->bytes() : sum;
  }

  ParticleNumbers numbers() const {
    ParticleNumbers all = particles.numbers();
    all.fluid = this->fluidOfAll, all.ghosts = 0;
    all.wall += distant->count();
    all.surfaces += distant->surfaceCount();
    return all;
  }

  void copyParticles(Particles<D>& host) const {
    if constexpr (std::is_same_v<Backend, Cpu>)
      if (context.communicator) {
        gatherParticles(*context.communicator, *context.halo, particles, numbers(), host);
        if (context.communicator->rank() == 0) distant->copyTo(host);
        return;
      }
    host.resize(numbers());
    copyFieldsToHost(context, particles, host);
    distant->copyTo(host);
  }
};

template <int D, class Backend>
Simulation<D, Backend>::Simulation(const Case& c, Particles<D> particles, std::int64_t step, double time,
                                   const Communicator* processes)
    : state_(std::make_unique<State>(c, std::move(particles), step, time, processes)) {}
template <int D, class Backend>
Simulation<D, Backend>::~Simulation() = default;
template <int D, class Backend>
Simulation<D, Backend>::Simulation(Simulation&&) noexcept = default;

template <int D, class Backend>
StepReport Simulation<D, Backend>::advance() {
  StepReport report;
  withTeam<Backend>([&] { report = state_->advance(); });
  return report;
}
template <int D, class Backend>
std::vector<SolverTrial> Simulation<D, Backend>::convergence(std::span<const SolverSettings> solvers) {
  std::vector<SolverTrial> trials;
  withTeam<Backend>([&] { trials = state_->convergence(solvers); });
  return trials;
}
template <int D, class Backend>
const Particles<D, Backend>& Simulation<D, Backend>::particles() const {
  return state_->particles;
}
template <int D, class Backend>
void Simulation<D, Backend>::copyParticles(Particles<D>& host) const {
  state_->copyParticles(host);
}
template <int D, class Backend>
ParticleNumbers Simulation<D, Backend>::numbers() const {
  return state_->numbers();
}
template <int D, class Backend>
double Simulation<D, Backend>::time() const {
  return state_->time;
}
template <int D, class Backend>
std::int64_t Simulation<D, Backend>::step() const {
  return state_->step;
}
template <int D, class Backend>
std::size_t Simulation<D, Backend>::bytes() const {
  return state_->bytes();
}
template <int D, class Backend>
std::size_t Simulation<D, Backend>::peakBytes() const {
  if constexpr (std::is_same_v<Backend, Cuda>) return state_->context.peakBytes();
  return 0;
}
template <int D, class Backend>
Diagnostics Simulation<D, Backend>::diagnostics() const {
  return state_->diagnostics();
}

#define TREACLE_INSTANTIATE(Backend)     \
  template class Simulation<2, Backend>; \
  template class Simulation<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
