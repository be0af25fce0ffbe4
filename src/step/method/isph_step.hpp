#pragma once

#include "isph_arrangement.hpp"
#include "isph_failure.hpp"
#include "isph_predictor.hpp"
#include "isph_solver.hpp"
#include "run/step_method.hpp"
#include "run/take_trial.hpp"
#include "step_gas.hpp"
#include "step_unknowns.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/closed_regions.hpp"
#include "treacle/isph/isph_particles.hpp"
#include "treacle/search/particle_sort.hpp"
#include "treacle/step/method/solve_stages.hpp"
#include "walls/isph_wall_forces.hpp"
#include "walls/placed_surfaces.hpp"

#include <optional>
#include <vector>

namespace treacle {

/// ISPH: predictor, pressure Poisson equation, corrector [O23 eqs. (7)-(11)].
template <int D, class Backend>
class IsphStep final : public StepMethod<D, Backend> {
 public:
  explicit IsphStep(FlowState<D, Backend>& state)
      : state_(state),
        pairs_(makeIsphPairs<D>(state.theCase)),
        predictor_(state, pairs_),
        pressure_(solveStages(solvedCase(state.theCase))),
        unknowns_(state) {
    if (pairs_.accurate) arrangement_.emplace(state);
    if (state.theCase.gas) gas_.emplace(state.theCase, nullptr), unknowns_.add(*gas_);
  }

  void sortParticles() override { sort_.sort(state_.context, pairs_.grid, state_.particles); }

  void findNeighbours() override {
    const Particles<D, Backend>& p = state_.particles;
    sort_.place(p, pairs_);
    pairs_.body = p.body.data();
    find(RowKind::FluidOfFluid, fluidOfFluid_);
    find(RowKind::WallsOfFluid, wallsOfFluid_);
    find(RowKind::FluidOfWalls, fluidOfWalls_);
    pairs_.fluidOfFluid = fluidOfFluid_.view();
    pairs_.fluidEntries = fluidOfFluid_.column.size();
    pairs_.wallsOfFluid = wallsOfFluid_.view();
    pairs_.fluidOfWalls = fluidOfWalls_.view();
    pairs_.wallSurface = nullptr;  // until they are placed
  }

  void computeDensities() override {
    prepareDensities();
    sumOnFluid(state_.context, pairs_, densityTerm());
  }

  /// v*, with walls that go with what rigid bodies are tried with first.
  StagedReport predict() override {
    unknowns_.start();
    pairs_.wallMotion = state_.wallMotion.empty() ? nullptr : state_.wallMotion.data();
    pairs_.timeStep = state_.timeStep;
    pairs_.frame = state_.frame;
    pairs_.materials.setTimeStep(state_.timeStep);
    placeWallSurfaces(state_, pairs_.fluidCount, pairs_.activeCount - pairs_.fluidCount, wallSurface_);
    if (pairs_.accurate && !state_.particles.wallSurface.empty()) pairs_.wallSurface = wallSurface_.data();
    prepareDensities();
    solution_.resize(state_.context, pairs_.fluidCount);
    state_.phases.run(state_.context, phases::coefficients, [&] {
      predictor_.start(densityTerm());
      if (pairs_.wallSurface) sumBesideWalls(state_.context, pairs_, AcrossWallsTerm<D>{});
      if (pairs_.mixingLength > 0) computeEddies();
    });
    return predictor_.predict(ranges(), solution());
  }

  void prepareSystem() override {
    fillGhosts(state_.context, Held::Fluid, surface_.data());
    if (pairs_.accurate) fillGhosts(state_.context, Held::Fluid, renormalisation_.data());
    findClosedRegions(state_.context, pairs_, ownSurface(), closed_);
    fillRegions(state_.context, closed_, missing_.span());
    if (gas_) gas_->prepare(state_, pairs_.grid, sort_.owners());
    computeSource();
    pressure_.prepareMatrix(state_.context, pairs_, ranges(), row());
  }

  void preparePreconditioner() override { pressure_.preparePreconditioner(state_.context); }

  StagedReport solve() override {
    StagedReport report;
    if (arrangement_) report = arrangement_->solve(pressure_, pairs_, closed_);
    guess(solution());
    report.follow(solveFlow());  // the residual is that of the flow
    return report;
  }

  /// Solves the pressure equation.
  SolverTrial solveBy(const SolverSettings& settings) override {
    const SolverSettings stage = singleStage(state_.theCase, settings);
    IsphSolver<D, Backend, PressureRow<D>> solver({stage});
    Buffer<double, Backend> x;
    x.resize(state_.context, pairs_.ownFluid());
    return takeTrial(
        state_.context, stage,
        [&] {
          solver.prepareMatrix(state_.context, pairs_, ranges(), row());
          solver.preparePreconditioner(state_.context);
        },
        [&](double* history) {
          guess(x);
          return solver.solve(state_.context, source_, x, history);
        });
  }

  void correctVelocities() override {
    if (!unknowns_.some()) correct(solution_);
  }

  void wallFriction(std::span<Vec<D>> force) override {
    sumOnFluid(state_.context, pairs_, WallFrictionTerm<D>{predictor_.viscousVelocity().data(), force.data()});
  }

  std::span<const Vec<D>> transportVelocities() override {
    const double coefficient = state_.theCase.method.isph.shifting;
    const std::span<const Vec<D>> transport =
        arrangement_ ? arrangement_->limited(pairs_, state_.velocity) : std::span<const Vec<D>>(state_.velocity);
    if (coefficient == 0) return transport;
    shifted_.resize(state_.context, pairs_.ownFluid());
    shiftedVelocity<D>(state_.context, {coefficient, state_.theCase.spacing, state_.timeStep}, deficit_,
                       ownSurface(), transport, shifted_);
    return shifted_.span();
  }

  double longestWay(double speed) const override {
    const int shifts = (state_.theCase.method.isph.shifting > 0) + arrangement_.has_value();
    return speed * state_.timeStep + shifts * longestShift * state_.theCase.spacing;
  }

  void accept() override {
    if (gas_) gas_->accept(state_);
    unknowns_.accept();
    std::span<double> pressure = state_.particles.pressure;
    copyValues(state_.context, std::span<const double>(solution_), pressure.data());
    clearValues(state_.context, pressure.subspan(pairs_.fluidCount));
    sumOnWalls(state_.context, pairs_, WallPressureTerm<D>{solution_.data(), pressure.data()});
    if (!state_.theCase.hasLoads()) return;
    loads_ = wallLoads(state_, loadsOfWalls());
    patches_ = forces_.pressures(state_, pairs_);
  }

  std::vector<WallLoad> loads() const override { return loads_; }
  std::vector<double> patchPressures() const override { return patches_; }

  void describe(DiagnosticsInput<D>& in) const override {
    const std::uint32_t n = state_.particles.fluidCount;
    if (surface_.size() != state_.particles.wallBegin()) return;
    in.density = state_.particles.numberDensity.span().first(n);
    in.surface = surface_.span().first(n);
    if (wallShare_.size() != n) return;
    in.wallDensity = wallShare_;
    in.neighbourDensity = 1 - pairs_.volume * pairs_.kernel.value(0) / pairs_.latticeDensity;
  }

  /// The linear system at hand, for those who solve it in other ways.
  const IsphPairs<D>& pairs() const { return pairs_; }
  const CellRanges<Backend>& ranges() const { return sort_.ranges(); }
  PressureRow<D> row() const { return {surface_.data()}; }
  std::span<const double> source() const { return source_; }

  const CellGrid<D>& grid() const override { return pairs_.grid; }
  const CellOwners<D>& owners() const override { return sort_.owners(); }
  const MaterialTable& materials() const override { return pairs_.materials; }
  std::size_t bytes() const override {
    return sort_.bytes() + fluidOfFluid_.bytes() + wallsOfFluid_.bytes() + fluidOfWalls_.bytes() +
           deficit_.bytes() + eddyViscosity_.bytes() + wallViscosity_.bytes() + renormalisation_.bytes() +
           acrossWalls_.bytes() + missing_.bytes() + surface_.bytes() + predictor_.bytes() + source_.bytes() +
           solution_.bytes() + shifted_.bytes() + (arrangement_ ? arrangement_->bytes() : 0) + wallShare_.bytes() +
           forces_.bytes() + pressure_.bytes() + (gas_ ? gas_->bytes() : 0) + pressing_.bytes() +
           wallSurface_.bytes() + closed_.bytes();
  }

  /// Pairs up to this share of the kernel's radius make the smoother's matrix: 1.9 l with the usual kernel.
  static constexpr double nearShare = 0.79;

 private:
  /// The flow, and the velocities and pressures that are found with it. Each solve starts from what the last step
  /// has left, which is zero where nothing moves and a right-hand side may be.
  StagedReport solveFlow() {
    if (unknowns_.hasBodies()) pressing_.resize(state_.context, pairs_.ownFluid());
    const auto flow = [&](bool isFirst) {
      const StagedReport report = solvePressure(isFirst);
      if (!unknowns_.some()) return report;
      correct(isFirst || !unknowns_.hasBodies() ? solution_ : pressing_);
      if (isFirst && unknowns_.hasBodies())
        copyValues(state_.context, std::span<const double>(solution()), pressing_.data());
      return report;
    };
    return unknowns_.solve(pairs_, wallSurface_, flow, [&] { return loadsOfWalls(); });
  }

  void computeSource() {
    Buffer<Vec<D>, Backend>& predicted = predictor_.velocity();
    const std::uint32_t own = pairs_.ownFluid();
    fillGhosts(state_.context, Held::Fluid, predicted.data());
    source_.resize(state_.context, own);
    sumOnFluid(state_.context, pairs_,
               PressureSourceTerm<D>{predicted.data(), state_.particles.numberDensity.data(), surface_.data(),
                                     source_.data(), arrangement_ ? arrangement_->source(own) : nullptr});
    if (gas_) {
      pairs_.outside = gas_->outside(state_).data();
      sumOnFluid(state_.context, pairs_, OutsideTerm<D>{surface_.data(), source_.data()});
    }
    takeLevels(state_.context, closed_, Level::Mean, source_.span());
  }

  /// The same again in the same step, with the velocities and forces of the unknowns; for the first time from what
  /// is prepared. Errors: RunError.
  StagedReport solvePressure(bool isFirst) {
    StagedReport report;
    if (!isFirst) {
      report = predictor_.follow(solution(), unknowns_.hasPumps());
      computeSource();
      guess(solution());
    }
    report.follow(solvePressure());
    return report;
  }

  /// From the guess in solution_, and to there. Errors: RunError.
  StagedReport solvePressure() {
    const StagedReport report = pressure_.solve(state_.context, source_, solution());
    requireConverged(state_, "pressure", report);
    return report;
  }

  /// The step's pressures, and velocities by them. `pressing`: CorrectorTerm.
  void correct(const Buffer<double, Backend>& pressing) {
    takeLevels(state_.context, closed_, pairs_.negativePressure ? Level::Mean : Level::Least, solution());
    settlePressure(state_.context, ownSurface(), pairs_.outside, !pairs_.negativePressure, solution());
    fillGhosts(state_.context, Held::Fluid, solution_.data());
    state_.velocity.resize(state_.context, pairs_.ownFluid());
    wallShare_.resize(state_.context, pairs_.ownFluid());
    Vec<D>* stopped =
        unknowns_.hasBodies() || state_.theCase.hasLoads() ? forces_.prepare(state_, pairs_) : nullptr;
    CorrectorTerm<D> term{solution_.data(),       pressing.data(),   predictor_.velocity().data(),
                          state_.velocity.data(), wallShare_.data(), stopped};
    if (arrangement_) arrangement_->addTo(term, pairs_, closed_, ownSurface(), solution());
    sumOnFluid(state_.context, pairs_, term);
  }

  /// Before the step changes the particles' velocities, which an explicit viscous step has taken its forces of.
  std::vector<LoadSums> loadsOfWalls() {
    std::vector<LoadSums> loads = forces_.loads(state_, pairs_, solution_, predictor_.viscousVelocity(),
                                                predictor_.isViscous(), predictor_.viscousFlow());
    if (gas_) gas_->addLoads(loads);
    return loads;
  }

  void find(RowKind kind, NeighbourRows<Backend>& rows) {
    const double radius = pairs_.kernel.radius();
    treacle::findNeighbours<D>(state_.context, pairs_, {nearShare * radius, radius}, kind, rows);
  }

  std::span<double> solution() { return solution_.span().first(pairs_.ownFluid()); }
  std::span<const std::uint8_t> ownSurface() const { return surface_.span().first(pairs_.ownFluid()); }

  /// The pressures of the last step.
  void guess(std::span<double> x) const {
    copyValues(state_.context, std::span<const double>(state_.particles.pressure).first(x.size()), x.data());
  }

  void prepareDensities() {
    const std::uint32_t n = pairs_.fluidCount;
    deficit_.resize(state_.context, pairs_.ownFluid());
    surface_.resize(state_.context, n);
    if (pairs_.accurate) {
      renormalisation_.resize(state_.context, n);
      missing_.resize(state_.context, pairs_.ownFluid());
      pairs_.renormalisation = pairs_.acrossWalls = renormalisation_.data();
      if (pairs_.wallSurface) {
        acrossWalls_.resize(state_.context, pairs_.ownFluid());
        pairs_.acrossWalls = acrossWalls_.data();
      }
      pairs_.missing = missing_.data();
    }
    clearValues(state_.context, state_.particles.numberDensity.span().subspan(n));
  }

  /// The viscosities of the turbulence model, by the velocities at the start of the step.
  void computeEddies() {
    eddyViscosity_.resize(state_.context, pairs_.fluidCount);
    wallViscosity_.resize(state_.context, pairs_.fluidCount);
    pairs_.eddyViscosity = eddyViscosity_.data();
    pairs_.wallViscosity = wallViscosity_.data();
    pairs_.mostEddyViscosity = pairs_.leastDensity * stableDiffusivity(pairs_);
    sumOnFluid(state_.context, pairs_,
               EddyTerm<D>{state_.particles.velocity.data(), predictor_.flow(), eddyViscosity_.data(),
                           wallViscosity_.data()});
    fillGhosts(state_.context, Held::Fluid, eddyViscosity_.data());
    fillGhosts(state_.context, Held::Fluid, wallViscosity_.data());
  }

  DensityTerm<D> densityTerm() {
    return {state_.particles.numberDensity.data(), deficit_.data(), surface_.data()};
  }

  FlowState<D, Backend>& state_;
  IsphPairs<D> pairs_;
  ParticleSort<D, Backend> sort_;
  NeighbourRows<Backend> fluidOfFluid_, wallsOfFluid_, fluidOfWalls_;
  ClosedRegions<Backend> closed_;
  Buffer<Vec<D>, Backend> deficit_;
  Buffer<SymmetricBlock<D, float>, Backend> renormalisation_;  // with ghosts; of the accurate scheme
  Buffer<SymmetricBlock<D, float>, Backend> acrossWalls_;  // likewise, of own particles; where surfaces are known
  Buffer<float, Backend> missing_;                         // likewise, of own particles
  Buffer<float, Backend> eddyViscosity_, wallViscosity_;   // of IsphPairs; of the turbulence model
  Buffer<std::uint8_t, Backend> surface_;  // Place, with ghosts, which all that neighbours read has
  IsphPredictor<D, Backend> predictor_;
  Buffer<double, Backend> source_;    // of the pressure equation
  Buffer<double, Backend> solution_;  // with ghosts: of the pressure equation; before, a component of v*
  Buffer<Vec<D>, Backend> shifted_;
  std::optional<IsphArrangement<D, Backend>> arrangement_;  // of the accurate scheme
  Buffer<double, Backend> wallShare_;                       // of the density in a full lattice
  IsphWallForces<D, Backend> forces_;                       // for rigid bodies and probes
  std::vector<WallLoad> loads_;                             // of the last step
  std::vector<double> patches_;                             // pressures of the probes WallPressure [Pa]
  IsphSolver<D, Backend, PressureRow<D>> pressure_;
  std::optional<StepGas<D, Backend>> gas_;       // where the case has gas
  StepUnknowns<D, Backend> unknowns_;            // where the case has rigid bodies, also:
  Buffer<double, Backend> pressing_;             // those of the step's first solve
  Buffer<WallSurface<D>, Backend> wallSurface_;  // per active wall particle
};

}  // namespace treacle
