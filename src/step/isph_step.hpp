#pragma once

#include "failure.hpp"
#include "isph_solver.hpp"
#include "step_method.hpp"
#include "take_trial.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/isph/isph_particles.hpp"
#include "treacle/model/particles_copy.hpp"
#include "treacle/search/particle_sort.hpp"
#include "treacle/step/solve_stages.hpp"
#include "wall_loads.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace treacle {

/// ISPH: predictor, pressure Poisson equation, corrector [O23 eqs. (7)-(11)].
template <int D, class Backend>
class IsphStep final : public StepMethod<D, Backend> {
 public:
  explicit IsphStep(FlowState<D, Backend>& state)
      : state_(state),
        pairs_(makeIsphPairs<D>(state.theCase)),
        viscousLimit_(explicitViscousLimit(pairs_)),
        pressure_(solveStages(state.theCase)),
        viscosity_(solveStages(state.theCase)) {}

  void sortParticles() override { sort_.sort(state_.context, pairs_.grid, state_.particles); }

  void findNeighbours() override {
    const Particles<D, Backend>& p = state_.particles;
    sort_.place(p, pairs_);
    pairs_.body = p.body.data();
    pairs_.wallMotion = state_.wallMotion.empty() ? nullptr : state_.wallMotion.data();
    find(RowKind::FluidOfFluid, fluidOfFluid_);
    find(RowKind::WallsOfFluid, wallsOfFluid_);
    find(RowKind::FluidOfWalls, fluidOfWalls_);
    pairs_.fluidOfFluid = fluidOfFluid_.view();
    pairs_.fluidEntries = fluidOfFluid_.column.size();
    pairs_.wallsOfFluid = wallsOfFluid_.view();
    pairs_.fluidOfWalls = fluidOfWalls_.view();
  }

  void computeDensities() override {
    prepareDensities();
    sumOnFluid(state_.context, pairs_, densityTerm());
  }

  /// v* of [O23 eq. (7)].
  StagedReport predict() override {
    pairs_.timeStep = state_.timeStep;
    pairs_.materials.setTimeStep(state_.timeStep);
    if (isImplicit()) return solveViscosity();
    state_.phases.run(state_.context, phases::coefficients, [&] {
      preparePrediction();
      const bool viscous = std::isfinite(viscousLimit_);
      if (viscous) fillGhosts(state_.context, Held::Fluid, state_.particles.velocity.data());
      const PredictorTerm<D> predictor{state_.particles.velocity.data(), predicted_.data(), viscous};
      sumOnFluid(state_.context, pairs_, BothTerms<DensityTerm<D>, PredictorTerm<D>>{densityTerm(), predictor});
    });
    return {};
  }

  void prepareSystem() override {
    fillGhosts(state_.context, Held::Fluid, predicted_.data());
    fillGhosts(state_.context, Held::Fluid, surface_.data());
    source_.resize(state_.context, pairs_.ownFluid());
    sumOnFluid(state_.context, pairs_,
               PressureSourceTerm<D>{predicted_.data(), state_.particles.numberDensity.data(), surface_.data(),
                                     source_.data()});
    closed_ = isClosed(state_.context, ownSurface());
    if (closed_) takeLevel(state_.context, Level::Mean, source_);
    pressure_.prepareMatrix(state_.context, pairs_, ranges(), row());
  }

  void preparePreconditioner() override { pressure_.preparePreconditioner(state_.context); }

  StagedReport solve() override {
    guess(solution());
    const StagedReport report = pressure_.solve(state_.context, source_, solution());
    if (report.status != SolveStatus::Converged) fail("pressure", report);
    return report;
  }

  /// Of the pressure equation.
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
    if (closed_) takeLevel(state_.context, pairs_.negativePressure ? Level::Mean : Level::Least, solution());
    settlePressure(state_.context, ownSurface(), !pairs_.negativePressure, solution());
    fillGhosts(state_.context, Held::Fluid, solution_.data());
    state_.velocity.resize(state_.context, pairs_.ownFluid());
    wallShare_.resize(state_.context, pairs_.ownFluid());
    if (state_.theCase.hasLoads()) stopped_.resize(state_.context, pairs_.fluidCount);
    sumOnFluid(state_.context, pairs_,
               CorrectorTerm<D>{solution_.data(), predicted_.data(), state_.velocity.data(), wallShare_.data(),
                                stopped_.data()});
  }

  std::span<const Vec<D>> transportVelocities() override {
    const double coefficient = state_.theCase.method.isph.shifting;
    if (coefficient == 0) return state_.velocity.span();
    transport_.resize(state_.context, pairs_.ownFluid());
    shiftedVelocity<D>(state_.context, {coefficient, state_.theCase.spacing, state_.timeStep}, deficit_,
                       ownSurface(), state_.velocity, transport_);
    return transport_.span();
  }

  double longestWay(double speed) const override {
    const double shift = state_.theCase.method.isph.shifting == 0 ? 0 : longestShift * state_.theCase.spacing;
    return speed * state_.timeStep + shift;
  }

  void accept() override {
    std::span<double> pressure = state_.particles.pressure;
    copyValues(state_.context, std::span<const double>(solution_), pressure.data());
    clearValues(state_.context, pressure.subspan(pairs_.fluidCount));
    sumOnWalls(state_.context, pairs_, WallPressureTerm<D>{solution_.data(), pressure.data()});
    if (state_.theCase.hasLoads()) sumLoadsOfWalls();
  }

  std::vector<WallLoad> loads() const override { return loads_; }

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
           deficit_.bytes() + surface_.bytes() + predicted_.bytes() + source_.bytes() + solution_.bytes() +
           transport_.bytes() + wallShare_.bytes() + stopped_.bytes() + wallForce_.bytes() + pressure_.bytes() +
           viscosity_.bytes() + componentBytes();
  }

  /// Pairs up to this share of the kernel's radius make the smoother's matrix: 1.9 l with the usual kernel.
  static constexpr double nearShare = 0.79;

 private:
  /// Before the step changes the particles' velocities, which an explicit viscous step has taken its forces of.
  void sumLoadsOfWalls() {
    const auto& rows = pairs_.fluidOfWalls;
    fillGhosts(state_.context, Held::Fluid, stopped_.data());
    wallForce_.resize(state_.context, rows.count);
    const std::span<const Vec<D>> start = state_.particles.velocity;
    sumOnWalls(state_.context, pairs_,
               WallForceTerm<D>{solution_.data(), isImplicit() ? predicted_.data() : start.data(), stopped_.data(),
                                std::isfinite(viscousLimit_), rows.first, wallForce_.data()});
    loads_ = wallLoads(state_, loadsOfBodies<D, Backend>(state_, rows.first, pairs_.position, start, wallForce_));
  }

  std::size_t componentBytes() const {
    std::size_t sum = 0;
    for (const auto& component : component_) sum += component.bytes();
    return sum;
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
    clearValues(state_.context, state_.particles.numberDensity.span().subspan(n));
  }
  DensityTerm<D> densityTerm() {
    return {state_.particles.numberDensity.data(), deficit_.data(), surface_.data()};
  }

  bool isImplicit() const {
    return isViscousStepImplicit(state_.theCase.method.isph.viscosity, viscousLimit_, state_.timeStep);
  }

  /// Room for v* and the pressures, and the velocities of the walls in v*.
  void preparePrediction() {
    const std::uint32_t n = pairs_.fluidCount, active = pairs_.activeCount;
    prepareDensities();
    predicted_.resize(state_.context, active);
    solution_.resize(state_.context, n);
    copyValues(state_.context, std::span<const Vec<D>>(state_.particles.velocity).subspan(n, active - n),
               predicted_.data() + n);
  }

  /// predicted = v* of (rho/dt - mu lap) v* = rho/dt v + rho g, one component after the other.
  StagedReport solveViscosity() {
    state_.phases.run(state_.context, phases::coefficients, [&] {
      preparePrediction();
      sumOnFluid(state_.context, pairs_, densityTerm());
      viscosity_.prepareMatrix(state_.context, pairs_, ranges(), ViscousRow<D>{});
      ViscousSourceTerm<D> term{state_.particles.velocity.data(), {}};
      for (int k = 0; k < D; ++k) {
        component_[k].resize(state_.context, pairs_.ownFluid());
        term.source[k] = component_[k].data();
      }
      sumOnFluid(state_.context, pairs_, term);
    });
    state_.phases.run(state_.context, phases::coarse, [&] { viscosity_.preparePreconditioner(state_.context); });
    StagedReport total;
    state_.phases.run(state_.context, phases::solve, [&] {
      for (int k = 0; k < D; ++k) total.follow(solveComponent(k));
    });
    return total;
  }

  StagedReport solveComponent(int k) {
    const std::uint32_t n = pairs_.ownFluid();
    takeComponent<D>(state_.context, std::span<const Vec<D>>(state_.particles.velocity).first(n), k, solution());
    StagedReport report = viscosity_.solve(state_.context, component_[k], solution());
    if (report.status != SolveStatus::Converged) fail("viscosity", report);
    putComponent<D>(state_.context, solution(), k, predicted_.span().first(n));
    return report;
  }

  [[noreturn]] void fail(const char* what, const StagedReport& report) {
    std::string diagnosis =
        fmt::format("{}: {}", what, describeFailure(report, state_.theCase.solver.tolerance, report.failures));
    if (report.status == SolveStatus::NotFinite) {
      Particles<D> host;
      copyToHost(state_.context, state_.particles, host);
      diagnosis += "; " + describeNotFinite<D>(state_.context, host, host.velocity);
    }
    throw RunError(diagnosis);
  }

  FlowState<D, Backend>& state_;
  IsphPairs<D> pairs_;
  double viscousLimit_;  // [s]
  ParticleSort<D, Backend> sort_;
  NeighbourRows<Backend> fluidOfFluid_, wallsOfFluid_, fluidOfWalls_;
  bool closed_ = false;  // no particle is at the free surface
  Buffer<Vec<D>, Backend> deficit_;
  Buffer<std::uint8_t, Backend> surface_;  // with ghosts, which all that neighbours read has
  Buffer<Vec<D>, Backend> predicted_;      // v*, with ghosts; walls: their velocities
  Buffer<double, Backend> source_;         // of the pressure equation
  Buffer<double, Backend> solution_;       // with ghosts: of the pressure equation; before, a component of v*
  Buffer<double, Backend> component_[D];   // of the viscous step's right-hand side
  Buffer<Vec<D>, Backend> transport_;
  Buffer<double, Backend> wallShare_;  // of the density in a full lattice
  Buffer<double, Backend> stopped_;    // of CorrectorTerm, with ghosts; empty where nobody asks for loads
  Buffer<Vec<D>, Backend> wallForce_;  // per own active wall particle, likewise [N/m3]
  std::vector<WallLoad> loads_;        // of the last step
  IsphSolver<D, Backend, PressureRow<D>> pressure_;
  IsphSolver<D, Backend, ViscousRow<D>> viscosity_;
};

}  // namespace treacle
