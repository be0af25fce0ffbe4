#pragma once

#include "isph_options.hpp"
#include "isph_system.hpp"
#include "library_mgcg.hpp"
#include "solve_record.hpp"
#include "treacle/search/buckets.hpp"

#include <cmath>
#include <limits>
#include <new>

namespace treacle {

/// All methods on one pressure equation.
template <int D>
class IsphComparison {
 public:
  IsphComparison(const IsphOptions& options, std::string name, IsphPressureSystem<D>& system, SolveRecord& record)
      : options_(options),
        name_(std::move(name)),
        system_(system),
        record_(record),
        context_(system.context()),
        sizes_(system.sizes()) {
    x_.resize(context_, system.fluidCount());
    try {
      matrixSeconds_ =
          medianSeconds([&] { assemblePressure(context_, system_.pairs(), system_.row(), matrix_, inverse_); });
      byMatrix_.prepare(context_, cusparse_, matrix_, CUSPARSE_SPMV_CSR_ALG1);
      hasMatrix_ = true;
    } catch (const std::exception& error) {
      matrix_ = {};
      record_.addFailure(name_, "matrix of the libraries", error.what());
    }
  }

  void runTreacle(const std::string& settings) {
    attempt(solverName(settings), [&](SolveResult& result) {
      const SolverSettings stage = options_.solverOf(settings);
      solveByTreacle(stage, result);
      const bool mixed = stage.precision == Precision::Mixed;
      const IterationBytes bytes{.sizes = sizes_,
                                 .number = mixed ? 4.0 : 8.0,
                                 .packed = mixed && sizes_.rows >= PackedEntries<Cuda>::fewest,
                                 .gridDegree = stage.hats.gridDegree};
      result.bytesPerIteration = bytes.ofSolver(stage.preconditioner);
    });
  }

  void runLibrary(const IsphLibraryVariant& variant) {
    attempt(variant.name, [&](SolveResult& result) { solveByLibrary(variant, result); });
  }

 private:
  template <class F>
  void attempt(const std::string& method, F&& solve) {
    SolveResult result;
    result.system = name_;
    result.method = method;
    result.fluidCount = system_.fluidCount();
    treacle::attempt(options_, record_, result, solve, [&] { return trueResidual(); });
  }
  template <class F>
  double medianSeconds(F&& work) {
    return treacle::medianSeconds(context_, options_.repetitions, work);
  }

  void setFirstGuess() { copyValues(context_, system_.firstGuess(), x_.data()); }

  /// Median seconds of a solve after one that warms up.
  double timeSolves(IsphSolver<D, Cuda, PressureRow<D>>& solver, SolveReport& report) {
    std::vector<double> seconds;
    for (int k = 0; k <= options_.repetitions; ++k) {
      setFirstGuess();
      clock_.start(context_);
      report = solver.solve(context_, system_.rightHandSide(), x_);
      clock_.mark(context_);
      if (k > 0) seconds.push_back(clock_.seconds()[0]);
    }
    return median(seconds);
  }

  void solveByTreacle(const SolverSettings& stage, SolveResult& result) {
    SolveReport report;
    const double perIteration = secondsPerIteration(stage);
    IsphSolver<D, Cuda, PressureRow<D>> solver({stage});
    prepare(solver, result);
    result.solveSeconds = timeSolves(solver, report);
    take(report, result);
    result.iterationSeconds = perIteration * report.iterations;
    result.how = "treacle";
  }

  void prepare(IsphSolver<D, Cuda, PressureRow<D>>& solver, SolveResult& result) {
    result.matrixSeconds =
        medianSeconds([&] { solver.prepareMatrix(context_, system_.pairs(), system_.ranges(), system_.row()); });
    // Once for each matrix: what the preconditioner alone reads is given up (giveUp).
    result.setupSeconds = medianSeconds([&] {
      solver.prepareMatrix(context_, system_.pairs(), system_.ranges(), system_.row());
      solver.preparePreconditioner(context_);
    });
  }

  /// What an iteration more costs, without the recording of the loop and the start: from solves that are stopped
  /// after so many iterations and after half of them. No tolerance stops them first; where rounding errors do, or
  /// the solve takes no iterations, there is no figure.
  double secondsPerIteration(SolverSettings stage) {
    stage.tolerance = std::numeric_limits<double>::min();
    const auto timeOf = [&](int iterations, SolveReport& report) {
      stage.maxIterations = iterations;
      IsphSolver<D, Cuda, PressureRow<D>> solver({stage});
      solver.prepareMatrix(context_, system_.pairs(), system_.ranges(), system_.row());
      solver.preparePreconditioner(context_);
      return timeSolves(solver, report);
    };
    constexpr int few = 12;  // twice as many leave single precision no zero residual
    SolveReport half, whole;
    const double ofHalf = timeOf(few, half), ofWhole = timeOf(2 * few, whole);
    const int more = whole.iterations - half.iterations;
    return more == few ? (ofWhole - ofHalf) / more : 0;
  }

  void solveByLibrary(const IsphLibraryVariant& variant, SolveResult& result) {
    if (!hasMatrix_) throw RunError("there is no matrix");
    BucketLevels<Cuda> levels;
    LibraryMgcg solver(context_, variant.algorithm);
    result.matrixSeconds = matrixSeconds_;
    result.setupSeconds = matrixSeconds_ + medianSeconds([&] { setup(variant, levels, solver); });
    SolveReport report;
    std::vector<double> whole, iterations;
    for (int k = 0; k <= options_.repetitions; ++k) {
      setFirstGuess();
      clock_.start(context_);
      solver.record(system_.rightHandSide(), x_, {options_.tolerance(), options_.maxIterations, 0});
      clock_.mark(context_);
      setFirstGuess();
      clock_.mark(context_);
      report = solver.solve();
      clock_.mark(context_);
      const std::vector<double>& seconds = clock_.seconds();
      if (k > 0) whole.push_back(seconds[0] + seconds[2]), iterations.push_back(seconds[2]);
    }
    result.solveSeconds = median(whole);
    result.iterationSeconds = median(iterations);
    take(report, result);
    result.how = solver.libraries() + ", " + solver.loop();
  }

  void setup(const IsphLibraryVariant& variant, BucketLevels<Cuda>& levels, LibraryMgcg& solver) {
    if (!variant.preconditioned) return solver.setup(matrix_, inverse_, {}, 0);
    findBuckets(context_, system_.ranges().key, D * CellGrid<D>::subBits, D, levels);
    std::span<const Buffer<std::uint32_t, Cuda>> members = levels.begin;
    if (variant.levels > 0) members = members.first(std::min<std::size_t>(variant.levels, members.size()));
    solver.setup(matrix_, inverse_, members, variant.sweeps);
  }

  static void take(const SolveReport& report, SolveResult& result) {
    result.iterations = report.iterations;
    result.converged = report.status == SolveStatus::Converged;
  }

  /// With the matrix of the libraries: it is made without anything of treacle's solvers.
  double trueResidual() {
    if (!hasMatrix_) return std::numeric_limits<double>::quiet_NaN();
    residual_.resize(context_, x_.size());
    copyValues(context_, system_.rightHandSide(), residual_.data());
    byMatrix_.multiply(-1, x_, 1, residual_);
    Buffer<double> b;
    copyToHost(context_, system_.rightHandSide(), b);
    const Buffer<double> r = copyToHost(context_, residual_);
    double rr = 0, bb = 0;
    for (std::size_t i = 0; i < b.size(); ++i) rr += r[i] * r[i], bb += b[i] * b[i];
    return std::sqrt(rr / bb);
  }

  const IsphOptions& options_;
  std::string name_;
  IsphPressureSystem<D>& system_;
  SolveRecord& record_;
  Context<Cuda>& context_;
  PressureSizes sizes_;
  PhaseClock<Cuda> clock_;
  CusparseHandle cusparse_{context_};
  ScalarCsr matrix_;
  Buffer<double, Cuda> inverse_, x_, residual_;
  LibraryProduct byMatrix_;
  bool hasMatrix_ = false;
  double matrixSeconds_ = 0;
};

}  // namespace treacle
