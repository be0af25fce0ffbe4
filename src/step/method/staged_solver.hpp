#pragma once

#include "mode_keeper.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/model/case/case.hpp"

#include <string>
#include <vector>

namespace treacle {

/// What became of a solve in stages: status and residual of the last one, iterations of all.
struct StagedReport : SolveReport {
  int fallbacks = 0;     // stages that were tried before the last one
  std::string failures;  // which these were, and why they were given up

  /// Takes the report of a solve that followed, with the iterations of both.
  void follow(const SolveReport& next) {
    const int before = iterations;
    static_cast<SolveReport&>(*this) = next;
    iterations += before;
  }
  void follow(const StagedReport& next) {
    follow(static_cast<const SolveReport&>(next));
    fallbacks += next.fallbacks;
    addFailures(next.failures);
  }
  void addFailures(const std::string& text) {
    if (!failures.empty() && !text.empty()) failures += "; ";
    failures += text;
  }
};

/// A linear system A x = b and its preconditioner K, in whatever form a stage wants them. What they are made of is
/// the business of those who derive from this.
template <class Backend>
class StagedSystem {
 public:
  virtual ~StagedSystem() = default;

  /// Everything that products with A take, then everything that those with K take.
  virtual void prepareOperator(Context<Backend>&, const SolverSettings& stage) = 0;
  virtual void preparePreconditioner(Context<Backend>&, const SolverSettings& stage) = 0;

  /// y = A x and z = K r of the stage that was prepared last.
  virtual void multiply(Context<Backend>&, std::span<const double> x, std::span<double> y) = 0;
  virtual void precondition(Context<Backend>&, std::span<const double> r, std::span<double> z) = 0;

  /// Whether products with numbers in single precision cost less than others; then directions of conjugate
  /// gradients are such ones, and their products come from here.
  virtual bool likesSingle() const { return false; }
  virtual void multiplySingle(Context<Backend>& context, std::span<const double> x, std::span<double> y) {
    multiply(context, x, y);
  }
};

/// Solves a system with the settings of its stages: a stage that fails is followed by the next one, from the best
/// guess there is. D numbers per particle; the first stage may be deflated by modes.
template <int D, class Backend = Cpu>
class StagedSolver {
 public:
  /// `stages`: of solveStages(). The system must outlive this.
  StagedSolver(StagedSystem<Backend>& system, std::vector<SolverSettings> stages)
      : system_(system), stages_(std::move(stages)) {}

  /// Prepare a new system; its first stage is next.
  void prepareOperator(Context<Backend>&);
  void preparePreconditioner(Context<Backend>&);

  /// `x`: first guess and solution. Several solves may follow each other with one system; a stage that failed is
  /// not tried again. `modes`: those that the first stage is deflated by, where it is, and takes anew when they
  /// are due; a failure drops them. Null: no solve is deflated. `history`: StoppingRule's, of the last stage.
  /// `looser`: times the tolerance of the stage, up to `loosest`.
  StagedReport solve(Context<Backend>&, std::span<const double> b, std::span<double> x,
                     SolverModes<D, Backend>* modes = nullptr, double* history = nullptr, double looser = 1);
  static constexpr double loosest = 1e-4;

  std::size_t bytes() const { return guess_.bytes() + krylov_.bytes() + keeper_.bytes(); }

 private:
  const SolverSettings& stage() const { return stages_[stage_]; }
  bool isLastStage() const { return stage_ + 1 == stages_.size(); }
  SolveReport solveStage(Context<Backend>&, std::span<const double> b, std::span<double> x,
                         SolverModes<D, Backend>* modes, double* history, double looser);
  void keepBetter(Context<Backend>&, const SolveReport&, std::span<double> x);

  StagedSystem<Backend>& system_;
  std::vector<SolverSettings> stages_;
  std::size_t stage_ = 0;          // the one that is prepared
  Buffer<double, Backend> guess_;  // the best one known, where there is a stage to fall back to
  KrylovWorkspace<Backend> krylov_;
  ModeKeeper<D, Backend> keeper_;
};

}  // namespace treacle
