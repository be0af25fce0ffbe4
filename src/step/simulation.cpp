#include "treacle/step/simulation.hpp"

#include "diagnostics.hpp"
#include "mph_solver.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/method/neighbourhood.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

template <int D>
std::string describe(const Vec<D>& x) {
  std::string text = fmt::format("({:.6g}", x[0]);
  for (int k = 1; k < D; ++k) text += fmt::format(", {:.6g}", x[k]);
  return text + ")";
}

template <int D>
bool isFinite(const Vec<D>& v) {
  return std::isfinite(norm2(v));
}

}  // namespace

template <int D>
struct Simulation<D>::State {
  Case c;
  Particles<D> particles;
  std::int64_t step;
  double time;

  Context<Cpu> context;
  Neighbourhood<D> neighbourhood;
  const MphPairs<D>& pairs;
  double restDensity;  // n_0 [-]
  bool wallsMove = false;
  Buffer<Block<D>> wallBlock;
  Buffer<Vec<D>> wallGradient;
  Buffer<double> elastic;                  // kappa [n - n_0]_+ per particle [Pa]
  Buffer<double> divergence;               // C^T u per particle [1/s]
  Buffer<Vec<D>> rhs, velocity, position;  // the step's results before they are accepted
  MphSolver<D> solver;

  State(const Case& theCase, Particles<D> state, std::int64_t startStep, double startTime)
      : c(theCase),
        particles(std::move(state)),
        step(startStep),
        time(startTime),
        neighbourhood(c),
        pairs(neighbourhood.pairs()),
        restDensity(latticeNumberDensity(pairs.pressureWeight, c.spacing)),
        solver(c.solver) {
    for (std::uint32_t i = particles.fluidCount; i < particles.count; ++i)
      wallsMove = wallsMove || norm2(particles.velocity[i]) > 0;
  }

  WallTerms<D> wallTermsView() { return {wallBlock.span(), wallGradient.span()}; }

  void computeDensities() {
    std::fill(particles.numberDensity.begin() + pairs.activeCount, particles.numberDensity.end(), 0.0);
    std::fill(particles.pressure.begin() + pairs.activeCount, particles.pressure.end(), 0.0);
    numberDensity<D>(context, pairs, particles.numberDensity.span().first(pairs.activeCount));
  }

  /// b of [K23 eq. (16)], and the terms of prescribed wall velocities.
  void computeRightHandSide() {
    const std::uint32_t n = particles.fluidCount, active = pairs.activeCount;
    const Vec<D> gravity = resized<D>(c.gravity);
    elastic.resize(active);
    for (std::uint32_t i = 0; i < active; ++i)
      elastic[i] = pairs.materials.bulkModulus[particles.material[i]] *
                   std::max(particles.numberDensity[i] - restDensity, 0.0);
    rhs.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      const int m = particles.material[i];
      rhs[i] = pairs.materials.inertia[m] * particles.velocity[i] + pairs.materials.density[m] * gravity;
    }
    addPressureGradient<D>(context, pairs, elastic, -1.0, rhs);
    if (wallsMove) addWallVelocities();
  }

  /// b -= A_full (0 on the fluid, u on the walls)
  void addWallVelocities() {
    const std::uint32_t n = particles.fluidCount, active = pairs.activeCount;
    velocity.resize(active);
    std::fill_n(velocity.begin(), n, Vec<D>{});
    std::copy(particles.velocity.begin() + n, particles.velocity.begin() + active, velocity.begin() + n);
    addWallDrag<D>(context, pairs, velocity, rhs);
    divergence.resize(active);
    treacle::divergence<D>(context, pairs, velocity, divergence);
    for (std::uint32_t i = 0; i < active; ++i)
      divergence[i] *= pairs.materials.bulkViscosity[particles.material[i]];
    addPressureGradient<D>(context, pairs, divergence, -1.0, rhs);
  }

  void computeCoefficients() {
    computeDensities();
    wallBlock.resize(particles.fluidCount);
    wallGradient.resize(particles.fluidCount);
    wallTerms<D>(context, pairs, wallTermsView());
    computeRightHandSide();
    solver.prepareOperator(context, pairs, wallTermsView());
  }

  /// First guess: the last velocity. The solution stands in `velocity`, walls included.
  SolveReport solve() {
    const std::uint32_t n = particles.fluidCount;
    velocity.resize(pairs.activeCount);
    std::copy_n(particles.velocity.begin(), pairs.activeCount, velocity.begin());
    const SolveReport report = solver.solve(context, rhs, velocity.span().first(n));
    if (report.status != SolveStatus::Converged) throw RunError(diagnose(report));
    return report;
  }

  std::string diagnose(const SolveReport& report) const {
    const std::string numbers = fmt::format("|r|^2/|b|^2 = {:.3g} after {} iterations (tolerance {:.3g})",
                                            report.residual, report.iterations, c.solver.tolerance);
    switch (report.status) {
      case SolveStatus::IterationLimit:
        return "the linear solver did not converge: " + numbers +
               "; raise solver.max_iterations, or reduce the time step or the bulk viscosity";
      case SolveStatus::Breakdown:
        return "the linear solver broke down, operator or preconditioner is not positive definite in working "
               "precision: " +
               numbers;
      default:
        return "the linear solver met a value that is not finite: " + numbers + "; " + firstNotFinite();
    }
  }

  std::string firstNotFinite() const {
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i)
      if (!isFinite(rhs[i]) || !isFinite(particles.position[i]))
        return fmt::format("the right-hand side of particle {} at {} m is not finite", particles.id[i],
                           describe(particles.position[i]));
    return "the right-hand side is finite";
  }

  /// x^{k+1} = x^k + dt u^{k+1} [K23 eq. (15)], walls by their prescribed velocity; into `position`.
  void move() {
    position.resize(particles.count);
    for (std::uint32_t i = 0; i < particles.count; ++i) {
      const Vec<D>& u = i < particles.fluidCount ? velocity[i] : particles.velocity[i];
      position[i] = particles.position[i] + c.time.step * u;
      if (i >= particles.fluidCount && !wallsMove) continue;
      if (!pairs.grid.wrap(position[i]))
        throw RunError(fmt::format("{} particle {} left the domain: from {} m to {} m at velocity {} m/s",
                                   i < particles.fluidCount ? "fluid" : "wall", particles.id[i],
                                   describe(particles.position[i]), describe(position[i]), describe(u)));
    }
  }

  /// Psi of [K23 eq. (14)] with the new velocities.
  void computePressure() {
    const std::uint32_t active = pairs.activeCount;
    divergence.resize(active);
    treacle::divergence<D>(context, pairs, velocity.span().first(active), divergence);
    for (std::uint32_t i = 0; i < active; ++i)
      particles.pressure[i] = pairs.materials.bulkViscosity[particles.material[i]] * divergence[i] + elastic[i];
  }

  void accept() {
    std::copy_n(velocity.begin(), particles.fluidCount, particles.velocity.begin());
    std::copy_n(position.begin(), particles.count, particles.position.begin());
    ++step;
    time = static_cast<double>(step) * c.time.step;
  }

  StepReport advance() {
    StepReport report;
    Timer timer;
    neighbourhood.sort(context, particles);
    report.seconds.search = timer.lap();
    neighbourhood.buildLists(context, particles);
    report.seconds.lists = timer.lap();
    computeCoefficients();
    report.seconds.coefficients = timer.lap();
    solver.preparePreconditioner(context, pairs, neighbourhood.ranges(), wallTermsView());
    report.seconds.coarse = timer.lap();
    const SolveReport solved = solve();
    report.seconds.solve = timer.lap();
    move();
    computePressure();
    accept();
    report.diagnostics = computeDiagnostics(c, pairs.materials, particles);
    report.seconds.update = timer.lap();
    report.step = step;
    report.time = time;
    report.iterations = solved.iterations;
    report.residual = solved.residual;
    return report;
  }

  std::size_t bytes() {
    std::size_t sum = neighbourhood.bytes() + wallBlock.bytes() + wallGradient.bytes() + elastic.bytes() +
                      divergence.bytes() + rhs.bytes() + velocity.bytes() + position.bytes() + solver.bytes();
    particles.forEachField([&](const auto& field) { sum += field.bytes(); });
    return sum;
  }
};

template <int D>
Simulation<D>::Simulation(const Case& c, Particles<D> particles, std::int64_t step, double time)
    : state_(std::make_unique<State>(c, std::move(particles), step, time)) {
  state_->neighbourhood.sort(state_->context, state_->particles);
  if (step > 0) return;  // the state has the densities of its last step
  // Frame 0 shows number densities.
  state_->neighbourhood.buildLists(state_->context, state_->particles);
  state_->computeDensities();
}
template <int D>
Simulation<D>::~Simulation() = default;
template <int D>
Simulation<D>::Simulation(Simulation&&) noexcept = default;

template <int D>
StepReport Simulation<D>::advance() {
  return state_->advance();
}
template <int D>
const Particles<D>& Simulation<D>::particles() const {
  return state_->particles;
}
template <int D>
void Simulation<D>::copyParticles(Particles<D>& host) const {
  const Particles<D>& p = state_->particles;
  host.resize(p.fluidCount, p.wallCount());
  // The bindings name all members: a field that is added does not compile until it is copied.
  const auto& [fluidCount, count, position, velocity, pressure, numberDensity, material, id] = p;
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); };
  copy(position, host.position), copy(velocity, host.velocity), copy(pressure, host.pressure);
  copy(numberDensity, host.numberDensity), copy(material, host.material), copy(id, host.id);
}
template <int D>
double Simulation<D>::time() const {
  return state_->time;
}
template <int D>
std::int64_t Simulation<D>::step() const {
  return state_->step;
}
template <int D>
std::size_t Simulation<D>::bytes() const {
  return state_->bytes();
}
template <int D>
Diagnostics Simulation<D>::diagnostics() const {
  return computeDiagnostics(state_->c, state_->pairs.materials, state_->particles);
}

template class Simulation<2>;
template class Simulation<3>;

}  // namespace treacle
