#include "mph_solver.hpp"
#include "step_balance.hpp"
#include "step_method.hpp"
#include "take_trial.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/step/first_guess.hpp"
#include "treacle/step/solve_stages.hpp"

namespace treacle {
namespace {

/// MPH-I: pressure and viscosity together in one system for the velocities [K23 eqs. (13)-(16)].
template <int D, class Backend>
class MphStep final : public StepMethod<D, Backend> {
 public:
  explicit MphStep(FlowState<D, Backend>& state)
      : s_(state), neighbourhood_(state.c), pairs_(neighbourhood_.pairs()), solver_(solveStages(state.c)) {}

  void sort() override { neighbourhood_.sort(s_.context, s_.particles); }
  void buildLists() override { neighbourhood_.buildLists(s_.context, s_.particles); }

  void computeDensities() override {
    const std::uint32_t active = pairs_.activeCount;
    clearValues(s_.context, s_.particles.numberDensity.span().subspan(active));
    clearValues(s_.context, s_.particles.pressure.span().subspan(active));
    numberDensity<D>(s_.context, pairs_, s_.particles.numberDensity.span().first(active));
  }

  void computeCoefficients() override {
    neighbourhood_.setTimeStep(s_.timeStep);
    computeDensities();
    wallBlock_.resize(s_.context, s_.particles.fluidCount);
    wallGradient_.resize(s_.context, s_.particles.fluidCount);
    wallTerms<D>(s_.context, pairs_, wallTermsView());
    computeRightHandSide();
    solver_.prepareOperator(s_.context, pairs_, wallTermsView());
  }

  void preparePreconditioner() override {
    solver_.preparePreconditioner(s_.context, pairs_, neighbourhood_.ranges(), wallTermsView());
  }

  /// Leaves the walls' velocities in state.velocity, too.
  StagedReport solve() override {
    const std::uint32_t n = pairs_.fluidCount, active = pairs_.activeCount;
    const std::span<const Vec<D>> last = s_.particles.velocity;
    s_.velocity.resize(s_.context, active);
    copyValues(s_.context, last.subspan(n, active - n), s_.velocity.data() + n);
    guess(s_.velocity.span().first(n));
    StagedReport report = solver_.solve(s_.context, rhs_, s_.velocity.span().first(n), &s_.particles.modes);
    if (report.status == SolveStatus::Converged) return report;
    std::string diagnosis = describeFailure(report, s_.c.solver.tolerance, report.failures);
    if (report.status == SolveStatus::NotFinite) diagnosis += "; " + notFiniteOnHost();
    throw RunError(diagnosis);
  }

  /// With the modes of the state where the settings have it deflate, as the next step would.
  SolverTrial solveBy(const SolverSettings& settings) override {
    const SolverSettings stage = singleStage(s_.c, settings);
    MphSolver<D, Backend> solver(stage);
    Buffer<Vec<D>, Backend> u;
    u.resize(s_.context, pairs_.fluidCount);
    return takeTrial(
        s_.context, stage,
        [&] {
          solver.prepareOperator(s_.context, pairs_, wallTermsView());
          solver.preparePreconditioner(s_.context, pairs_, neighbourhood_.ranges(), wallTermsView());
        },
        [&](double* history) {
          guess(u);
          const SolverModes<D, Backend>& kept = s_.particles.modes;
          SolverModes<D, Backend> modes;
          modes.vectors.resize(s_.context, kept.vectors.size());
          copyValues(s_.context, kept.vectors.span(), modes.vectors.data());
          modes.age = kept.age;
          return solver.solve(s_.context, rhs_, u, &modes, history);
        });
  }

  std::span<const Vec<D>> transport() override { return s_.velocity.span().first(pairs_.fluidCount); }

  /// Psi of [K23 eq. (14)] with the new velocities.
  void accept() override {
    const std::uint32_t active = pairs_.activeCount, n = pairs_.fluidCount;
    divergence_.resize(s_.context, active);
    divergence<D>(s_.context, pairs_, s_.velocity.span().first(active), divergence_);
    bulkPressure<D>(s_.context, pairs_, divergence_, elastic_, s_.particles.pressure.span().first(active));
    if (s_.c.output.balance) lastBalance_ = balance_.make(s_, neighbourhood_, divergence_, elastic_);
    // The velocities of the start are given, no solution: nothing follows from the way to the first one.
    if (s_.step > 0)
      remember<D>(s_.context, s_.timeStep, s_.particles.velocity.span().first(n), s_.velocity.span().first(n),
                  memory());
  }

  std::optional<Balance> balance() const override { return lastBalance_; }

  const CellGrid<D>& grid() const override { return pairs_.grid; }
  const MaterialTable& materials() const override { return pairs_.materials; }
  std::size_t bytes() const override {
    return neighbourhood_.bytes() + wallBlock_.bytes() + wallGradient_.bytes() + elastic_.bytes() +
           divergence_.bytes() + rhs_.bytes() + solver_.bytes() + balance_.bytes();
  }

 private:
  FlowMemory<D> memory() { return {s_.particles.acceleration.span(), s_.particles.jerk.span()}; }
  void guess(std::span<Vec<D>> u) {
    extrapolate<D>(s_.context, Extrapolation<D>::make(s_.c.solver.firstGuess, s_.timeStep),
                   s_.particles.velocity.span().first(u.size()), memory(), u);
  }
  WallTerms<D> wallTermsView() { return {wallBlock_.span(), wallGradient_.span()}; }

  /// b of [K23 eq. (16)], and the terms of prescribed wall velocities.
  void computeRightHandSide() {
    elastic_.resize(s_.context, pairs_.activeCount);
    elasticPressure<D>(s_.context, pairs_, s_.particles.numberDensity.span().first(pairs_.activeCount), elastic_);
    rhs_.resize(s_.context, s_.particles.fluidCount);
    inertiaAndGravity<D>(s_.context, pairs_, s_.particles.velocity.span().first(s_.particles.fluidCount),
                         resized<D>(s_.c.gravity), rhs_);
    addPressureGradient<D>(s_.context, pairs_, elastic_, -1.0, rhs_);
    if (s_.wallsMove) addWallVelocities();
  }

  /// b -= A_full (0 on the fluid, u on the walls)
  void addWallVelocities() {
    const std::uint32_t n = s_.particles.fluidCount, active = pairs_.activeCount;
    const std::span<const Vec<D>> u = s_.particles.velocity;
    s_.velocity.resize(s_.context, active);
    clearValues(s_.context, s_.velocity.span().first(n));
    copyValues(s_.context, u.subspan(n, active - n), s_.velocity.data() + n);
    addWallDrag<D>(s_.context, pairs_, s_.velocity, rhs_);
    divergence_.resize(s_.context, active);
    divergence<D>(s_.context, pairs_, s_.velocity, divergence_);
    bulkPressure<D>(s_.context, pairs_, divergence_, {}, divergence_);
    addPressureGradient<D>(s_.context, pairs_, divergence_, -1.0, rhs_);
  }

  std::string notFiniteOnHost() {
    Particles<D> host;
    toHost(s_.context, s_.particles, host);
    Buffer<Vec<D>> b(rhs_.size());
    if constexpr (std::is_same_v<Backend, Cuda>)
      copyToHost(s_.context, std::span<const Vec<D>>(rhs_), b);
    else
      copyValues(s_.context, std::span<const Vec<D>>(rhs_), b.data());
    return describeNotFinite<D>(host, b);
  }

  FlowState<D, Backend>& s_;
  MphNeighbourhood<D, Backend> neighbourhood_;
  const MphPairs<D>& pairs_;
  Buffer<Block<D>, Backend> wallBlock_;
  Buffer<Vec<D>, Backend> wallGradient_;
  Buffer<double, Backend> elastic_;     // kappa [n - n_0]_+ per particle [Pa]
  Buffer<double, Backend> divergence_;  // C^T u per particle [1/s]
  Buffer<Vec<D>, Backend> rhs_;
  MphSolver<D, Backend> solver_;
  StepBalance<D, Backend> balance_;
  std::optional<Balance> lastBalance_;
};

}  // namespace

template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeMphStep(FlowState<D, Backend>& state) {
  return std::make_unique<MphStep<D, Backend>>(state);
}

template std::unique_ptr<StepMethod<2, Cpu>> makeMphStep(FlowState<2, Cpu>&);
template std::unique_ptr<StepMethod<3, Cpu>> makeMphStep(FlowState<3, Cpu>&);
#ifdef TREACLE_HAS_CUDA
template std::unique_ptr<StepMethod<2, Cuda>> makeMphStep(FlowState<2, Cuda>&);
template std::unique_ptr<StepMethod<3, Cuda>> makeMphStep(FlowState<3, Cuda>&);
#endif

}  // namespace treacle
