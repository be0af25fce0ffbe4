#include "treacle/step/simulation.hpp"

#include "failure.hpp"
#include "mph_solver.hpp"
#include "treacle/core/phase_clock.hpp"
#include "treacle/core/trace.hpp"
#include "treacle/method/explicit_step.hpp"
#include "treacle/method/neighbourhood.hpp"
#include "treacle/model/particles_copy.hpp"
#include "treacle/step/diagnostics.hpp"
#include "treacle/step/first_guess.hpp"
#include "treacle/step/solve_stages.hpp"

namespace treacle {
namespace {

template <class T>
void copyValues(Context<Cpu>&, std::span<const T> from, T* to) {
  std::copy(from.begin(), from.end(), to);
}
template <class T>
void copyValues(Context<Cuda>& context, std::span<const T> from, T* to) {
  copyBytesOnDevice(context, from.data(), to, from.size_bytes());
}
template <class T>
void clear(Context<Cpu>&, std::span<T> values) {
  std::fill(values.begin(), values.end(), T{});
}
template <class T>
void clear(Context<Cuda>& context, std::span<T> values) {
  clearBytes(context, values.data(), values.size_bytes());
}

template <int D>
void toBackend(Context<Cpu>&, Particles<D> host, Particles<D>& particles) {
  particles = std::move(host);
}
template <int D>
void toBackend(Context<Cuda>& context, const Particles<D>& host, Particles<D, Cuda>& particles) {
  copyToDevice(context, host, particles);
}
template <int D>
void toHost(const Context<Cpu>&, const Particles<D>& particles, Particles<D>& host) {
  host.resize(particles.fluidCount, particles.wallCount());
  forEachFieldOf([](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); }, particles,
                 host);
}
template <int D>
void toHost(const Context<Cuda>& context, const Particles<D, Cuda>& particles, Particles<D>& host) {
  copyToHost(context, particles, host);
}

template <int D>
bool someWallMoves(const Particles<D>& particles) {
  for (std::uint32_t i = particles.fluidCount; i < particles.count; ++i)
    if (norm2(particles.velocity[i]) > 0) return true;
  return false;
}

}  // namespace

template <int D, class Backend>
struct Simulation<D, Backend>::State {
  Case c;
  std::int64_t step;
  double time;
  bool wallsMove;

  mutable Context<Backend> context;
  Particles<D, Backend> particles;
  Neighbourhood<D, Backend> neighbourhood;
  const MphPairs<D>& pairs;
  double restDensity;  // n_0 [-]
  Buffer<Block<D>, Backend> wallBlock;
  Buffer<Vec<D>, Backend> wallGradient;
  Buffer<double, Backend> elastic;                  // kappa [n - n_0]_+ per particle [Pa]
  Buffer<double, Backend> divergence;               // C^T u per particle [1/s]
  Buffer<Vec<D>, Backend> rhs, velocity, position;  // the step's results before they are accepted
  MphSolver<D, Backend> solver;
  PhaseClock<Backend> clock;

  State(const Case& theCase, Particles<D> state, std::int64_t startStep, double startTime)
      : c(theCase),
        step(startStep),
        time(startTime),
        wallsMove(someWallMoves(state)),
        neighbourhood(c),
        pairs(neighbourhood.pairs()),
        restDensity(latticeNumberDensity(pairs.pressureWeight, c.spacing)),
        solver(solveStages(c)) {
    toBackend(context, std::move(state), particles);
    if (step == 0) forEachFluidFieldOf([&](auto& field) { clear(context, field.span()); }, particles);
  }

  FlowMemory<D> memory() { return {particles.acceleration.span(), particles.jerk.span()}; }

  WallTerms<D> wallTermsView() { return {wallBlock.span(), wallGradient.span()}; }

  void computeDensities() {
    const std::uint32_t active = pairs.activeCount;
    clear(context, particles.numberDensity.span().subspan(active));
    clear(context, particles.pressure.span().subspan(active));
    numberDensity<D>(context, pairs, particles.numberDensity.span().first(active));
  }

  /// b of [K23 eq. (16)], and the terms of prescribed wall velocities.
  void computeRightHandSide() {
    elastic.resize(context, pairs.activeCount);
    elasticPressure<D>(context, pairs, particles.numberDensity.span().first(pairs.activeCount), restDensity,
                       elastic);
    rhs.resize(context, particles.fluidCount);
    inertiaAndGravity<D>(context, pairs, particles.velocity.span().first(particles.fluidCount),
                         resized<D>(c.gravity), rhs);
    addPressureGradient<D>(context, pairs, elastic, -1.0, rhs);
    if (wallsMove) addWallVelocities();
  }

  /// b -= A_full (0 on the fluid, u on the walls)
  void addWallVelocities() {
    const std::uint32_t n = particles.fluidCount, active = pairs.activeCount;
    const std::span<const Vec<D>> u = particles.velocity;
    velocity.resize(context, active);
    clear(context, velocity.span().first(n));
    copyValues(context, u.subspan(n, active - n), velocity.data() + n);
    addWallDrag<D>(context, pairs, velocity, rhs);
    divergence.resize(context, active);
    treacle::divergence<D>(context, pairs, velocity, divergence);
    bulkPressure<D>(context, pairs, divergence, {}, divergence);
    addPressureGradient<D>(context, pairs, divergence, -1.0, rhs);
  }

  void computeCoefficients() {
    computeDensities();
    wallBlock.resize(context, particles.fluidCount);
    wallGradient.resize(context, particles.fluidCount);
    wallTerms<D>(context, pairs, wallTermsView());
    computeRightHandSide();
    solver.prepareOperator(context, pairs, wallTermsView());
  }

  /// The solution stands in `velocity`, walls included.
  StagedReport solve() {
    const std::uint32_t n = particles.fluidCount, active = pairs.activeCount;
    const std::span<const Vec<D>> last = particles.velocity;
    velocity.resize(context, active);
    copyValues(context, last.subspan(n, active - n), velocity.data() + n);
    extrapolate<D>(context, Extrapolation<D>::make(c.solver.firstGuess, c.time.step), last.first(n), memory(),
                   velocity.span().first(n));
    StagedReport report = solver.solve(context, rhs, velocity.span().first(particles.fluidCount));
    if (report.status == SolveStatus::Converged) return report;
    std::string diagnosis = describeFailure(report, c.solver.tolerance, report.failures);
    if (report.status == SolveStatus::NotFinite) diagnosis += "; " + notFiniteOnHost();
    throw RunError(diagnosis);
  }

  std::string notFiniteOnHost() {
    Particles<D> host;
    toHost(context, particles, host);
    Buffer<Vec<D>> b(rhs.size());
    if constexpr (std::is_same_v<Backend, Cuda>)
      copyToHost(context, std::span<const Vec<D>>(rhs), b);
    else
      copyValues(context, std::span<const Vec<D>>(rhs), b.data());
    return describeNotFinite<D>(host, b);
  }

  /// x^{k+1} of [K23 eq. (15)] into `position`; walls by their prescribed velocity.
  void move() {
    position.resize(context, particles.count);
    moveRange(0, particles.fluidCount, velocity);
    if (wallsMove) moveRange(particles.fluidCount, particles.count, particles.velocity);
  }

  void moveRange(std::uint32_t begin, std::uint32_t end, std::span<const Vec<D>> u) {
    const std::span<const Vec<D>> x = particles.position;
    const std::uint32_t size = end - begin;
    const std::uint32_t out = moveParticles<D>(context, pairs.grid, c.time.step, x.subspan(begin, size),
                                               u.subspan(begin, size), position.span().subspan(begin, size));
    if (out == nobody) return;
    Particles<D> host;
    toHost(context, particles, host);
    Vec<D> uOut{};
    if constexpr (std::is_same_v<Backend, Cuda>)
      uOut = valueOnHost(context, &u[begin + out]);
    else
      uOut = u[begin + out];
    throw RunError(describeLeaving<D>(host, begin + out, uOut, c.time.step));
  }

  /// Psi of [K23 eq. (14)] with the new velocities.
  void computePressure() {
    const std::uint32_t active = pairs.activeCount;
    divergence.resize(context, active);
    treacle::divergence<D>(context, pairs, velocity.span().first(active), divergence);
    bulkPressure<D>(context, pairs, divergence, elastic, particles.pressure.span().first(active));
  }

  void accept() {
    const std::uint32_t moved = wallsMove ? particles.count : particles.fluidCount;
    const std::span<const Vec<D>> u = std::span<const Vec<D>>(velocity).first(particles.fluidCount);
    // The velocities of the start are given, no solution: nothing follows from the way to the first one.
    if (step > 0) remember<D>(context, c.time.step, particles.velocity.span().first(u.size()), u, memory());
    copyValues(context, u, particles.velocity.data());
    copyValues(context, std::span<const Vec<D>>(position).first(moved), particles.position.data());
    ++step;
    time = static_cast<double>(step) * c.time.step;
  }

  Diagnostics diagnostics() const {
    const std::uint32_t n = particles.fluidCount;
    return computeDiagnostics<D>(
        context, {particles.position.span().first(n), particles.velocity.span().first(n),
                  particles.material.span().first(n), pairs.materials, resized<D>(c.gravity), c.spacing});
  }

  /// Runs one phase under its name in a profiler, and takes its time.
  template <class F>
  void phase(const char* name, F&& work) {
    const TraceRange range(name);
    work();
    clock.mark(context);
  }

  StepReport advance() {
    StepReport report;
    StagedReport solved;
    clock.start(context);
    phase("search", [&] { neighbourhood.sort(context, particles); });
    phase("lists", [&] { neighbourhood.buildLists(context, particles); });
    phase("coefficients", [&] { computeCoefficients(); });
    phase("coarse operators",
          [&] { solver.preparePreconditioner(context, pairs, neighbourhood.ranges(), wallTermsView()); });
    phase("solve", [&] { solved = solve(); });
    phase("update", [&] {
      move();
      computePressure();
      accept();
      report.diagnostics = diagnostics();
    });
    const std::vector<double>& s = clock.seconds();
    report.seconds = {s[0], s[1], s[2], s[3], s[4], s[5]};
    report.step = step;
    report.time = time;
    report.iterations = solved.iterations;
    report.residual = solved.residual;
    report.fallbacks = solved.fallbacks;
    report.failures = std::move(solved.failures);
    return report;
  }

  std::size_t bytes() const {
    std::size_t sum = neighbourhood.bytes() + wallBlock.bytes() + wallGradient.bytes() + elastic.bytes() +
                      divergence.bytes() + rhs.bytes() + velocity.bytes() + position.bytes() + solver.bytes();
    particles.forEachField([&](const auto& field) { sum += field.bytes(); });
    return sum;
  }
};

template <int D, class Backend>
Simulation<D, Backend>::Simulation(const Case& c, Particles<D> particles, std::int64_t step, double time)
    : state_(std::make_unique<State>(c, std::move(particles), step, time)) {
  state_->neighbourhood.sort(state_->context, state_->particles);
  if (step > 0) return;  // the state has the densities of its last step
  // Frame 0 shows number densities.
  state_->neighbourhood.buildLists(state_->context, state_->particles);
  state_->computeDensities();
}
template <int D, class Backend>
Simulation<D, Backend>::~Simulation() = default;
template <int D, class Backend>
Simulation<D, Backend>::Simulation(Simulation&&) noexcept = default;

template <int D, class Backend>
StepReport Simulation<D, Backend>::advance() {
  return state_->advance();
}
template <int D, class Backend>
const Particles<D, Backend>& Simulation<D, Backend>::particles() const {
  return state_->particles;
}
template <int D, class Backend>
void Simulation<D, Backend>::copyParticles(Particles<D>& host) const {
  toHost(state_->context, state_->particles, host);
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

template class Simulation<2, Cpu>;
template class Simulation<3, Cpu>;
#ifdef TREACLE_HAS_CUDA
template class Simulation<2, Cuda>;
template class Simulation<3, Cuda>;
#endif

}  // namespace treacle
