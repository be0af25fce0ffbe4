#include "mph_right_hand_side.hpp"
#include "mph_solver.hpp"
#include "readings/step_balance.hpp"
#include "run/failure.hpp"
#include "run/step_method.hpp"
#include "run/take_trial.hpp"
#include "step_gas.hpp"
#include "step_guess.hpp"
#include "step_heat.hpp"
#include "step_places.hpp"
#include "step_states.hpp"
#include "step_surface.hpp"
#include "step_tension.hpp"
#include "step_unknowns.hpp"
#include "step_viscosities.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/mph/renormalisation.hpp"
#include "treacle/step/method/solve_stages.hpp"
#include "walls/placed_surfaces.hpp"
#include "walls/wall_forces.hpp"

#include <cmath>
#include <vector>

namespace treacle {
namespace {

/// MPH-I: pressure and viscosity together in one system for the velocities [K23 eqs. (13)-(16)].
template <int D, class Backend>
class MphStep final : public StepMethod<D, Backend> {
 public:
  explicit MphStep(FlowState<D, Backend>& state)
      : state_(state),
        neighbourhood_(state.theCase),
        pairs_(neighbourhood_.pairs()),
        wholeRows_(needsAssembled<Backend>(state.theCase.solver)),
        solver_(solveStages(solvedCase(state.theCase))),
        viscosities_(state.theCase),
        unknowns_(state) {
    if (state.theCase.hasStates()) states_.emplace();
    if (state.theCase.heat) heat_.emplace(state.theCase, pairs_);
    if (state.theCase.hasSurfaceTension()) surface_.emplace(state.theCase);
    if (state.theCase.keepsVolume()) tension_.emplace();
    if (state.theCase.gas) gas_.emplace(state.theCase, explicitForces()), unknowns_.add(*gas_);
    if (state.theCase.elasticModes() > 0) elasticity_.emplace(state.theCase, explicitForces());
    if (state.theCase.isAccurate()) viscosities_.addStiffness(state.theCase, explicitForces());
  }

  void sortParticles() override { neighbourhood_.sort(state_.context, state_.particles); }
  void findNeighbours() override { neighbourhood_.buildLists(state_.context, state_.particles, wholeRows_); }

  void computeDensities() override {
    const std::uint32_t active = pairs_.activeCount;
    clearValues(state_.context, state_.particles.pressure.span().subspan(active));
    clearValues(state_.context, state_.particles.heldPressure.span().subspan(active));
    places_.compute(state_, pairs_,
                    rheology() ? rheology()->setVolumes(state_, pairs_) : std::span<const double>{});
  }

  /// Walls go with what rigid bodies are tried with first.
  StagedReport predict() override {
    viscosities_.remember(state_, pairs_);
    unknowns_.start();
    return {};
  }

  void prepareSystem() override {
    neighbourhood_.setTimeStep(state_.velocityStep);
    neighbourhood_.raiseBulk(state_.theCase, state_.particles.bulk);
    placeWallSurfaces();
    computeDensities();
    renormalise();
    if (state_.theCase.needsWallNeighbours()) wallForces_.prepare(state_, neighbourhood_);
    if (surface_) surface_->prepare(state_, pairs_, wallForces_.walls());
    setViscosities();
    if (elasticity_) elasticity_->prepare(state_, pairs_);
    viscosities_.giveBack(state_, pairs_);
    if (tension_) tension_->prepare(state_, pairs_, places_.of(state_));
    if (gas_) gas_->prepare(state_, pairs_.grid, neighbourhood_.owners());
    prepareViscous();
  }

  /// What is kept of another step's system is that of one of about the same length, with the same viscosities.
  void preparePreconditioner() override {
    if (viscosities_.change() || std::abs(state_.timeStep - state_.lastStep()) > 0.1 * state_.lastStep())
      state_.particles.modes.pressure = {};
    solver_.preparePreconditioner(state_.context, &state_.particles.modes.pressure);
  }

  /// Leaves the walls' velocities in state.velocity, too.
  StagedReport solve() override {
    guess_.setAll(pairs_);
    const auto flow = [&](bool isFirst) {
      if (isFirst) return solveFluid();
      keepVelocities([&] { unknowns_.hasPressures() ? computeRightHandSide() : rhs_.takeWallVelocities(); });
      return solveOnce();
    };
    return unknowns_.solve(pairs_, wallSurface_, flow, [&] { return loads(); });
  }

  /// With the modes of the state where the settings have it deflate, as the next step would.
  SolverTrial solveBy(const SolverSettings& settings) override {
    const SolverSettings stage = singleStage(state_.theCase, settings);
    if (needsAssembled<Backend>(stage) && !wholeRows_) {
      wholeRows_ = true;
      findNeighbours();
    }
    MphSolver<D, Backend> solver(stage);
    // As the next step would, where its solver is tried; that of another precision has another eigenvalue.
    KeptEigenvalue pressure;
    if (stage.precision == state_.theCase.solver.precision) pressure = state_.particles.modes.pressure;
    Buffer<Vec<D>, Backend> u;
    u.resize(state_.context, pairs_.ownFluid());
    return takeTrial(
        state_.context, stage,
        [&] {
          solver.prepareOperator(state_.context, pairs_, neighbourhood_.ranges(), wallTermsView());
          solver.preparePreconditioner(state_.context, &pressure);
        },
        [&](double* history) {
          guess_.set(u);
          const SolverModes<D, Backend>& kept = state_.particles.modes;
          SolverModes<D, Backend> modes;
          modes.vectors.resize(state_.context, kept.vectors.size());
          copyValues(state_.context, kept.vectors.span(), modes.vectors.data());
          modes.age = kept.age;
          return solver.solve(state_.context, rhs_.values(), u, &modes, history);
        });
  }

  /// Elastic stresses, states and temperatures, which may fail before anything is accepted.
  void correctVelocities() override {
    if (elasticity_) elasticity_->solve(state_, pairs_);
    if (states_) states_->solve(state_, *rheology());
    if (heat_)
      heat_->solve(state_, pairs_, states_ ? states_->heating() : std::span<const double>{},
                   elasticity_ ? elasticity_->power() : std::span<const double>{});
  }

  void wallFriction(std::span<Vec<D>> force) override {
    treacle::wallFriction<D>(state_.context, pairs_, wallBlock_, state_.velocity, force);
    addWallDrag<D>(state_.context, pairs_, state_.velocity, force);
  }

  std::span<const Vec<D>> transportVelocities() override {
    if (!tension_) return state_.velocity.span().first(pairs_.ownFluid());
    return tension_->transport(state_, pairs_);
  }

  double longestWay(double speed) const override {
    return speed * state_.timeStep + (tension_ ? longestShift * state_.theCase.spacing : 0);
  }

  void accept() override {
    const std::uint32_t n = pairs_.ownFluid();
    computePressures(state_.particles.pressure.span().first(pairs_.activeCount));
    if (rheology()) rheology()->accept(state_);
    if (states_) states_->accept(state_);
    if (elasticity_) elasticity_->accept(state_);
    if (state_.theCase.needsBalance())
      lastBalance_ = balance_.make(state_, pairs_, divergence_, rhs_.elastic(), surface_ ? &*surface_ : nullptr,
                                   tension_ ? &*tension_ : nullptr, explicitForces(), rhs_.buoyancy(volumes()));
    if (heat_) acceptHeat();
    if (gas_) gas_->accept(state_);
    unknowns_.accept();
    if (tension_) tension_->accept(state_, pairs_, places_.of(state_));
    if (viscosities_.change()) state_.particles.modes.pressure = {};  // those of the next step may not
    guess_.accept(n);
  }

  double pressedWay() const override { return viscosities_.stiffness() ? viscosities_.stiffness()->way() : 0; }
  void describe(DiagnosticsInput<D>& in) const override { places_.describe(state_, pairs_, in); }

  std::optional<Balance> balance() const override { return lastBalance_; }
  std::vector<WallLoad> loads() const override {
    return lastBalance_ ? lastBalance_->walls : std::vector<WallLoad>{};
  }
  std::vector<double> patchPressures() const override {
    return lastBalance_ ? lastBalance_->patches : std::vector<double>{};
  }

  const CellGrid<D>& grid() const override { return pairs_.grid; }
  const CellOwners<D>& owners() const override { return neighbourhood_.owners(); }
  const MaterialTable& materials() const override { return pairs_.materials; }
  std::size_t bytes() const override {
    return neighbourhood_.bytes() + wallSurface_.bytes() + slipSide_.bytes() + renormalisation_.bytes() +
           viscosities_.bytes() + (states_ ? states_->bytes() : 0) + (heat_ ? heat_->bytes() : 0) +
           (surface_ ? surface_->bytes() : 0) + (tension_ ? tension_->bytes() : 0) + wallBlock_.bytes() +
           wallGradient_.bytes() + places_.bytes() + divergence_.bytes() + rhs_.bytes() + found_.bytes() +
           solver_.bytes() + balance_.bytes() + wallForces_.bytes() + (gas_ ? gas_->bytes() : 0) +
           (elasticity_ ? elasticity_->bytes() : 0) + pressure_.bytes();
  }

 private:
  /// The flow for the velocities that walls have, from the guess in state.velocity.
  StagedReport solveFluid() {
    StagedReport report = solveOnce();
    while (rheology()) {
      const bool again = rheology()->follow(state_, neighbourhood_);
      if (rheology()->isAnother()) state_.particles.modes.pressure = {};
      if (!again) break;
      prepareAgain();
      report.follow(solveOnce());
    }
    return report;
  }

  /// Psi of [K23 eq. (14)] per active particle, and divergence_, with the velocities in state.velocity [Pa].
  void computePressures(std::span<double> pressure) {
    const std::uint32_t active = pairs_.activeCount;
    divergence_.resize(state_.context, active);
    divergence<D>(state_.context, pairs_, state_.velocity.span().first(active), divergence_);
    fillGhosts(state_.context, Held::Active, divergence_.data());
    bulkPressure<D>(state_.context, pairs_, divergence_, rhs_.elastic(), pressure);
  }

  /// What bodies bear with the velocities in state.velocity.
  std::vector<LoadSums> loads() {
    pressure_.resize(state_.context, pairs_.activeCount);
    computePressures(pressure_);
    wallForces_.sum(state_, pairs_, state_.velocity, pressure_, explicitForces());
    return wallForces_.loads(state_, pairs_, state_.velocity);
  }

  void acceptHeat() {
    heat_->accept(state_);
    if (!lastBalance_) return;
    lastBalance_->heat = heat_->balance(std::pow(pairs_.spacing, D));
    if (states_) lastBalance_->heat->states = states_->power();
  }

  /// All that the viscosity is in, on neighbours, densities and velocities that stay.
  void prepareViscous() {
    wallBlock_.resize(state_.context, state_.particles.fluidCount);
    const bool productsTakeGradient = std::is_same_v<Backend, Cpu> || !pairs_.renormalisation;
    wallGradient_.resize(state_.context, productsTakeGradient ? state_.particles.fluidCount : 0);
    wallTerms<D>(state_.context, pairs_, wallTermsView());
    computeRightHandSide();
    solver_.prepareOperator(state_.context, pairs_, neighbourhood_.ranges(), wallTermsView());
  }

  /// Once more with other viscosities, from the velocities that there are.
  void prepareAgain() {
    keepVelocities([&] {
      prepareViscous();
      preparePreconditioner();
    });
  }

  /// What `prepare` leaves of the fluid in state.velocity is of no use: it is put back. Walls have their present
  /// velocities then.
  template <class F>
  void keepVelocities(F&& prepare) {
    const std::uint32_t fluid = pairs_.fluidCount;
    found_.resize(state_.context, fluid);
    copyValues(state_.context, std::span<const Vec<D>>(state_.velocity).first(fluid), found_.data());
    prepare();
    copyValues(state_.context, std::span<const Vec<D>>(found_), state_.velocity.data());
  }

  /// From the guess in state.velocity, and to there, ghosts included. Errors: RunError.
  StagedReport solveOnce() {
    SolverModes<D, Backend>& modes = state_.particles.modes;
    const bool noModes = state_.context.halo && state_.context.halo->someHaveNone;
    StagedReport report =
        solver_.solve(state_.context, rhs_.values(), state_.velocity.span().first(pairs_.ownFluid()),
                      noModes ? nullptr : &modes);
    fillGhosts(state_.context, Held::Fluid, state_.velocity.data());
    if (report.fallbacks == 0 && report.status == SolveStatus::Converged)
      modes.pressure.solved(report.iterations);
    else
      modes.pressure = {};
    if (report.status == SolveStatus::Converged) return report;
    std::string diagnosis = describeFailure(report, state_.theCase.solver.tolerance, report.failures);
    if (report.status == SolveStatus::NotFinite) diagnosis += "; " + notFiniteOnHost();
    throw RunError(diagnosis);
  }

  WallTerms<D> wallTermsView() { return {wallBlock_.span(), wallGradient_.span()}; }

  void placeWallSurfaces() {
    treacle::placeWallSurfaces(state_, pairs_.fluidCount, pairs_.activeCount - pairs_.fluidCount, wallSurface_);
    if (state_.particles.wallSurface.empty()) return;
    neighbourhood_.setWallSurfaces(wallSurface_);
    neighbourhood_.setWallMotion(state_.wallMotion, state_.particles.body.data());
    if (!pairs_.slips()) return;
    slipSide_.resize(state_.context, pairs_.fluidCount);
    slipSides<D>(state_.context, pairs_, slipSide_.span().first(pairs_.ownFluid()));
    fillGhosts(state_.context, Held::Fluid, slipSide_.data());
    neighbourhood_.setSlipSides(slipSide_);
  }

  /// B, which everything that contains C needs.
  void renormalise() {
    if (!state_.theCase.isAccurate()) return;
    renormalisation_.resize(state_.context, pairs_.fluidCount);
    renormalisation<D>(state_.context, pairs_, renormalisation_.span());
    if (tension_)
      neighbourhood_.setWallShares(
          tension_->letGapsClose(state_, pairs_, places_.of(state_), renormalisation_.span()));
    fillGhosts(state_.context, Held::Fluid, renormalisation_.data());
    neighbourhood_.setRenormalisation(renormalisation_);
  }

  void setViscosities() {
    if (rheology()) {
      guess_.setAll(pairs_);
      fillGhosts(state_.context, Held::Active, state_.velocity.data());
    }
    viscosities_.set(state_, neighbourhood_, elasticity_ ? &*elasticity_ : nullptr);
  }

  void computeRightHandSide() {
    rhs_.compute(surface_ ? surface_->adhesion() : std::span<const Adhesion<D>>{}, volumes(), explicitForces());
    if (gas_) gas_->addPressures(state_, rhs_.values());
  }

  /// Factors of own fluid [-]; empty where there are none.
  std::span<const double> volumes() const {
    if (!state_.theCase.hasVolumeFactors()) return {};
    return viscosities_.rheology()->volumes().first(state_.particles.fluidCount);
  }

  StepRheology<D, Backend>* rheology() { return viscosities_.rheology(); }

  const ExplicitForces<D, Backend>* explicitForces() const {
    if (viscosities_.stiffness()) return viscosities_.stiffness();
    if (elasticity_) return &*elasticity_;
    if (gas_) return &*gas_;
    if (surface_) return &*surface_;
    return tension_ ? &*tension_ : nullptr;
  }

  std::string notFiniteOnHost() {
    Particles<D> host;
    copyToHost(state_.context, state_.particles, host);
    Buffer<Vec<D>> b(rhs_.values().size());
    copyToHost(state_.context, std::span<const Vec<D>>(rhs_.values()), b.data());
    return describeNotFinite<D>(state_.context, host, b);
  }

  FlowState<D, Backend>& state_;
  MphNeighbourhood<D, Backend> neighbourhood_;
  const MphPairs<D>& pairs_;
  bool wholeRows_;                               // of A in the lists
  Buffer<WallSurface<D>, Backend> wallSurface_;  // per active wall particle
  Buffer<SlipSide<D>, Backend> slipSide_;        // per fluid particle, where some fluid slips
  Buffer<SymmetricBlock<D>, Backend> renormalisation_;
  Buffer<Block<D>, Backend> wallBlock_;
  Buffer<Vec<D>, Backend> wallGradient_;
  StepPlaces<D, Backend> places_;
  Buffer<double, Backend> divergence_;  // C^T u per particle [1/s]
  StepGuess<D, Backend> guess_{state_};
  MphRightHandSide<D, Backend> rhs_{state_, pairs_, divergence_};
  MphSolver<D, Backend> solver_;
  StepViscosities<D, Backend> viscosities_;
  Buffer<Vec<D>, Backend> found_;  // velocities of the last solve, while the next is prepared
  std::optional<StepElasticity<D, Backend>> elasticity_;  // where a fluid is elastic
  std::optional<StepStates<D, Backend>> states_;          // where materials have states
  std::optional<StepHeat<D, Backend>> heat_;              // where the case has heat
  std::optional<StepSurface<D, Backend>> surface_;        // where some fluid has a surface tension
  std::optional<StepTension<D, Backend>> tension_;        // where the case keeps its volume
  std::optional<StepGas<D, Backend>> gas_;                // where the case has gas
  StepUnknowns<D, Backend> unknowns_;
  Buffer<double, Backend> pressure_;   // per active particle, where the case has rigid bodies [Pa]
  WallForces<D, Backend> wallForces_;  // for rigid bodies, the balance and surface tension
  StepBalance<D, Backend> balance_{wallForces_};
  std::optional<Balance> lastBalance_;
};

}  // namespace

template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeMphStep(FlowState<D, Backend>& state) {
  return std::make_unique<MphStep<D, Backend>>(state);
}

#define TREACLE_INSTANTIATE(Backend)                                                    \
  template std::unique_ptr<StepMethod<2, Backend>> makeMphStep(FlowState<2, Backend>&); \
  template std::unique_ptr<StepMethod<3, Backend>> makeMphStep(FlowState<3, Backend>&);
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
