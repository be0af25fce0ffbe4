#pragma once

#include "library_solver.hpp"
#include "method/mph_solver.hpp"
#include "solve_record.hpp"
#include "studied_system.hpp"
#include "treacle/core/error.hpp"
#include "treacle/mph/mph_operator.hpp"

#include <cmath>
#include <new>
#include <optional>
#include <sstream>

namespace treacle {

/// Settings of treacle's own solver, as case files have them under [solver]. What a line leaves out has its
/// default.
inline const std::vector<std::string> defaultSolvers = {
    "preconditioner=bucket-multigrid krylov=cr precision=double",
    "preconditioner=bucket-multigrid krylov=cr precision=mixed",
    "preconditioner=projected-multigrid krylov=cg precision=double",
    "preconditioner=projected-multigrid krylov=cg precision=mixed",
    "preconditioner=block-jacobi krylov=cg precision=double",
};

/// "treacle: bucket-multigrid cr double": the common keys go without saying.
inline std::string solverName(const std::string& settings) {
  std::string name = "treacle:";
  std::istringstream words(settings);
  for (std::string word; words >> word;) {
    for (const std::string key : {"preconditioner=", "krylov=", "precision="})
      if (word.starts_with(key)) word.erase(0, key.size());
    name += " " + word;
  }
  return name;
}

struct LibraryVariant {
  const char* name;
  LibraryMethod method;
  cusparseSpMVAlg_t algorithm;
};
inline constexpr LibraryVariant libraryVariants[] = {
    {"libraries: bucket-multigrid cr", LibraryMethod::MultigridCr, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: bucket-multigrid cr, SpMV ALG2", LibraryMethod::MultigridCr, CUSPARSE_SPMV_CSR_ALG2},
    {"libraries: cr", LibraryMethod::Cr, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: block-jacobi cg", LibraryMethod::BlockJacobiCg, CUSPARSE_SPMV_CSR_ALG1},
};

/// All methods on one system of equations.
template <int D>
class SolveComparison {
 public:
  SolveComparison(const SolveOptions& options, std::string name, StudiedSystem<D, Cuda>& system,
                  SolveRecord& record)
      : options_(options), name_(std::move(name)), system_(system), record_(record), context_(system.context) {
    u_.resize(context_, system.fluidCount());
    try {
      assemblySeconds_ = medianSeconds([&] { system_.assembleMatrix(); });
    } catch (const std::bad_alloc&) {
      system_.dropMatrix();
    }
    copyToHost(context_, system.rightHandSide(), b_);
  }

  void runTreacle(const std::string& settings) {
    attempt(solverName(settings), [&](SolveResult& result) {
      std::vector<std::string> overrides;
      std::istringstream words(settings);
      for (std::string word; words >> word;) overrides.push_back("solver." + word);
      SolverSettings solver = paperCase(options_, D, 1, overrides).solver;
      solver.tolerance = options_.tolerance;
      solver.maxIterations = options_.maxIterations;
      solveByTreacle(solver, result);
    });
  }
  void runLibrary(const LibraryVariant& variant) {
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

  void setFirstGuess() {
    copyBytesOnDevice(context_, system_.firstGuess().data(), u_.data(), system_.firstGuess().size_bytes());
  }

  void solveByTreacle(const SolverSettings& settings, SolveResult& result) {
    MphSolver<D, Cuda> solver(settings);
    result.setupSeconds = medianSeconds([&] {
      solver.prepareOperator(context_, system_.pairs(), system_.ranges(), system_.terms());
      solver.preparePreconditioner(context_);
    });
    SolveReport report;
    std::vector<double> seconds;
    for (int k = 0; k <= options_.repetitions; ++k) {
      setFirstGuess();
      clock_.start(context_);
      report = solver.solve(context_, system_.rightHandSide(), u_);
      clock_.mark(context_);
      if (k > 0) seconds.push_back(clock_.seconds()[0]);
    }
    result.solveSeconds = median(seconds);
    take(report, result);
    result.how = "treacle";
  }

  void solveByLibrary(const LibraryVariant& variant, SolveResult& result) {
    if (system_.matrix.rows() == 0) throw RunError("the matrix does not fit into the device's memory");
    if (!scalar_) {
      scalar_.emplace();
      scalarMatrix<D>(context_, system_.matrix, *scalar_);
    }
    LibrarySolver<D> solver(context_, variant.method, variant.algorithm);
    result.setupSeconds = assemblySeconds_ + medianSeconds([&] {
                            solver.setup(system_.pairs(), system_.terms(), *scalar_, system_.ranges().key);
                          });
    SolveReport report;
    std::vector<double> whole, iterations;
    for (int k = 0; k <= options_.repetitions; ++k) {
      clock_.start(context_);
      solver.record(system_.rightHandSide(), u_, {options_.tolerance, options_.maxIterations, 0});
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

  static void take(const SolveReport& report, SolveResult& result) {
    result.iterations = report.iterations;
    result.converged = report.status == SolveStatus::Converged;
  }

  double trueResidual() {
    au_.resize(context_, u_.size());
    if (system_.matrix.rows() > 0) {
      multiply<D, double>(context_, system_.matrix, u_, au_);
    } else {
      MphOperator<D, Cuda> a;
      a.prepare(context_, system_.pairs(), system_.terms());
      a.multiply(context_, u_, au_);
    }
    const Buffer<Vec<D>> au = copyToHost(context_, au_);
    double rr = 0, bb = 0;
    for (std::size_t i = 0; i < au.size(); ++i) rr += norm2(b_[i] - au[i]), bb += norm2(b_[i]);
    return std::sqrt(rr / bb);
  }

  const SolveOptions& options_;
  std::string name_;
  StudiedSystem<D, Cuda>& system_;
  SolveRecord& record_;
  Context<Cuda>& context_;
  PhaseClock<Cuda> clock_;
  double assemblySeconds_ = 0;
  Buffer<Vec<D>> b_;
  Buffer<Vec<D>, Cuda> u_, au_;
  std::optional<ScalarCsr> scalar_;
};

}  // namespace treacle
