#pragma once

#include "isph_solver.hpp"
#include "step_method.hpp"
#include "take_trial.hpp"
#include "treacle/isph/isph_particles.hpp"
#include "treacle/step/solve_stages.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {

/// ISPH: predictor, pressure Poisson equation, corrector [O23 eqs. (7)-(11)].
template <int D, class Backend>
class IsphStep final : public StepMethod<D, Backend> {
 public:
  explicit IsphStep(FlowState<D, Backend>& state)
      : s_(state),
        pairs_(makeIsphPairs<D>(state.c)),
        viscousLimit_(explicitViscousLimit(pairs_)),
        pressure_(solveStages(state.c)),
        viscosity_(solveStages(state.c)) {}

  void sort() override { sortByCell(s_.context, pairs_.grid, s_.particles, ranges_, workspace_); }

  void buildLists() override {
    const Particles<D, Backend>& p = s_.particles;
    pairs_.fluidCount = p.fluidCount;
    pairs_.activeCount = ranges_.activeCount;
    pairs_.position = p.position;
    pairs_.material = p.material;
    pairs_.cells = viewOf(ranges_);
    pairs_.body = p.body.data();
    pairs_.wallMotion = s_.wallMotion.empty() ? nullptr : s_.wallMotion.data();
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
    sumOnFluid(s_.context, pairs_, densityTerm());
  }

  void computeCoefficients() override {
    const std::uint32_t n = pairs_.fluidCount, active = pairs_.activeCount;
    pairs_.timeStep = s_.timeStep;
    pairs_.materials.setTimeStep(s_.timeStep);
    prepareDensities();
    predicted_.resize(s_.context, active);
    copyValues(s_.context, std::span<const Vec<D>>(s_.particles.velocity).subspan(n, active - n),
               predicted_.data() + n);
    if (isImplicit()) {
      sumOnFluid(s_.context, pairs_, densityTerm());
      solveViscosity();
    } else {
      const PredictorTerm<D> predictor{s_.particles.velocity.data(), predicted_.data(),
                                       std::isfinite(viscousLimit_)};
      sumOnFluid(s_.context, pairs_, BothTerms<DensityTerm<D>, PredictorTerm<D>>{densityTerm(), predictor});
    }
    source_.resize(s_.context, n);
    sumOnFluid(s_.context, pairs_,
               PressureSourceTerm<D>{predicted_.data(), s_.particles.numberDensity.data(), surface_.data(),
                                     source_.data()});
    pressure_.prepareMatrix(s_.context, pairs_, row());
  }

  void preparePreconditioner() override { pressure_.preparePreconditioner(s_.context, ranges_); }

  StagedReport solve() override {
    guess(solution_);
    const StagedReport report = pressure_.solve(s_.context, source_, solution_);
    if (report.status != SolveStatus::Converged) fail("pressure", report);
    return report;
  }

  /// Of the pressure equation.
  SolverTrial solveBy(const SolverSettings& settings) override {
    const SolverSettings stage = singleStage(s_.c, settings);
    PairSolver<D, Backend, PressureRow<D>> solver({stage});
    Buffer<double, Backend> x;
    return takeTrial(
        s_.context, stage,
        [&] {
          solver.prepareMatrix(s_.context, pairs_, row());
          solver.preparePreconditioner(s_.context, ranges_);
        },
        [&](double* history) {
          guess(x);
          return solver.solve(s_.context, source_, x, history);
        });
  }

  /// The corrector.
  std::span<const Vec<D>> transport() override {
    settlePressure(s_.context, surface_, !pairs_.negativePressure, solution_);
    s_.velocity.resize(s_.context, pairs_.fluidCount);
    sumOnFluid(s_.context, pairs_, CorrectorTerm<D>{solution_.data(), predicted_.data(), s_.velocity.data()});
    const double coefficient = s_.c.method.isph.shifting;
    if (coefficient == 0) return s_.velocity.span();
    transport_.resize(s_.context, pairs_.fluidCount);
    shiftedVelocity<D>(s_.context, {coefficient, s_.c.spacing, s_.timeStep}, deficit_, surface_, s_.velocity,
                       transport_);
    return transport_.span();
  }

  void accept() override {
    const std::uint32_t n = pairs_.fluidCount;
    std::span<double> pressure = s_.particles.pressure;
    copyValues(s_.context, std::span<const double>(solution_), pressure.data());
    clearValues(s_.context, pressure.subspan(n));
    sumOnWalls(s_.context, pairs_, WallPressureTerm<D>{solution_.data(), pressure.data()});
  }

  void describe(DiagnosticsInput<D>& in) const override {
    if (surface_.size() != s_.particles.fluidCount) return;
    in.density = s_.particles.numberDensity.span().first(s_.particles.fluidCount);
    in.surface = surface_;
  }

  /// The linear system at hand, for those who solve it in other ways.
  const IsphPairs<D>& pairs() const { return pairs_; }
  const CellRanges<Backend>& ranges() const { return ranges_; }
  PressureRow<D> row() const { return {surface_.data()}; }
  std::span<const double> source() const { return source_; }

  const CellGrid<D>& grid() const override { return pairs_.grid; }
  const MaterialTable& materials() const override { return pairs_.materials; }
  std::size_t bytes() const override {
    return ranges_.bytes() + workspace_.bytes() + fluidOfFluid_.bytes() + wallsOfFluid_.bytes() +
           fluidOfWalls_.bytes() + deficit_.bytes() + surface_.bytes() + predicted_.bytes() + source_.bytes() +
           solution_.bytes() + transport_.bytes() + pressure_.bytes() + viscosity_.bytes() + componentBytes();
  }

  /// Pairs up to this share of the kernel's radius make the smoother's matrix: 1.9 l with the usual kernel.
  static constexpr double nearShare = 0.79;

 private:
  std::size_t componentBytes() const {
    std::size_t sum = 0;
    for (const auto& component : component_) sum += component.bytes();
    return sum;
  }

  void find(RowKind kind, NeighbourRows<Backend>& rows) {
    const double radius = pairs_.kernel.radius();
    findNeighbours<D>(s_.context, pairs_.grid, pairs_.cells, pairs_.position, pairs_.fluidCount,
                      pairs_.activeCount, {nearShare * radius, radius}, kind, rows);
  }

  /// The pressures of the last step.
  void guess(Buffer<double, Backend>& x) const {
    x.resize(s_.context, pairs_.fluidCount);
    copyValues(s_.context, std::span<const double>(s_.particles.pressure).first(pairs_.fluidCount), x.data());
  }

  void prepareDensities() {
    const std::uint32_t n = pairs_.fluidCount;
    deficit_.resize(s_.context, n);
    surface_.resize(s_.context, n);
    clearValues(s_.context, s_.particles.numberDensity.span().subspan(n));
  }
  DensityTerm<D> densityTerm() { return {s_.particles.numberDensity.data(), deficit_.data(), surface_.data()}; }

  bool isImplicit() const { return isViscousStepImplicit(s_.c.method.isph.viscosity, viscousLimit_, s_.timeStep); }

  /// predicted = v* of (rho/dt - mu lap) v* = rho/dt v + rho g, one component after the other.
  void solveViscosity() {
    const std::uint32_t n = pairs_.fluidCount;
    viscosity_.prepareMatrix(s_.context, pairs_, ViscousRow<D>{});
    viscosity_.preparePreconditioner(s_.context, ranges_);
    ViscousSourceTerm<D> term{s_.particles.velocity.data(), {}};
    for (int k = 0; k < D; ++k) {
      component_[k].resize(s_.context, n);
      term.source[k] = component_[k].data();
    }
    sumOnFluid(s_.context, pairs_, term);
    solution_.resize(s_.context, n);
    const std::span<const Vec<D>> last = std::span<const Vec<D>>(s_.particles.velocity).first(n);
    for (int k = 0; k < D; ++k) {
      takeComponent<D>(s_.context, last, k, solution_);
      const StagedReport report = viscosity_.solve(s_.context, component_[k], solution_);
      if (report.status != SolveStatus::Converged) fail("viscosity", report);
      putComponent<D>(s_.context, solution_, k, predicted_.span().first(n));
    }
  }

  [[noreturn]] void fail(const char* what, const StagedReport& report) {
    std::string diagnosis =
        fmt::format("{}: {}", what, describeFailure(report, s_.c.solver.tolerance, report.failures));
    if (report.status == SolveStatus::NotFinite) {
      Particles<D> host;
      toHost(s_.context, s_.particles, host);
      diagnosis += "; " + describeNotFinite<D>(host, host.velocity);
    }
    throw RunError(diagnosis);
  }

  FlowState<D, Backend>& s_;
  IsphPairs<D> pairs_;
  double viscousLimit_;  // [s]
  CellRanges<Backend> ranges_;
  SortWorkspace<Backend> workspace_;
  NeighbourRows<Backend> fluidOfFluid_, wallsOfFluid_, fluidOfWalls_;
  Buffer<Vec<D>, Backend> deficit_;
  Buffer<std::uint8_t, Backend> surface_;
  Buffer<Vec<D>, Backend> predicted_;          // v*; walls: their velocities
  Buffer<double, Backend> source_, solution_;  // of the pressure equation; before, a component of v*
  Buffer<double, Backend> component_[D];       // of the viscous step's right-hand side
  Buffer<Vec<D>, Backend> transport_;
  PairSolver<D, Backend, PressureRow<D>> pressure_;
  PairSolver<D, Backend, ViscousRow<D>> viscosity_;
};

}  // namespace treacle
