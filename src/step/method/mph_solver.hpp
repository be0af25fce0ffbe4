#pragma once

#include "staged_solver.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/precondition/projected_multigrid.hpp"
#include "treacle/search/shared_buckets.hpp"

#include <vector>

namespace treacle {

/// Whether a stage of a solver takes A as a matrix: the pairs' lists must then hold whole rows.
template <class Backend>
bool needsAssembled(const SolverSettings& stage);

/// The system of a step of MPH-I for the velocities, A = rho/dt I + V + C Lambda C^T, and its preconditioners.
template <int D, class Backend = Cpu>
class MphSystem final : public StagedSystem<Backend> {
 public:
  /// What the system of a step is made of. All of it must outlive the solves.
  void setStep(const MphPairs<D>& pairs, const CellRanges<Backend>& ranges, const WallTerms<D>& terms);

  /// What the next preconditioner may use of those before it; null: nothing.
  void keepEigenvalue(KeptEigenvalue* pressure) { pressure_ = pressure; }

  void prepareOperator(Context<Backend>&, const SolverSettings& stage) override;
  void preparePreconditioner(Context<Backend>&, const SolverSettings& stage) override;
  void multiply(Context<Backend>&, std::span<const double> x, std::span<double> y) override;
  void precondition(Context<Backend>&, std::span<const double> r, std::span<double> z) override;

  std::size_t bytes() const;

 private:
  /// The data of K in the precision of a stage.
  template <class T>
  struct Preconditioner {
    Buffer<Vec<D, T>, Backend> inverse;         // jacobi, and the particles of bucket-multigrid
    Buffer<Block<D, T>, Backend> blockInverse;  // block-jacobi
    BucketMultigrid<D, T, Backend> multigrid;   // bucket-multigrid
    ProjectedMultigrid<D, T, Backend> projected;
  };

  template <class F>
  void withPrecision(F&& f);
  template <class T>
  void prepare(Context<Backend>&, Preconditioner<T>&);
  template <class T>
  void prepareMultigrid(Context<Backend>&, Preconditioner<T>&);

  SolverSettings stage_;  // the one that is prepared
  KeptEigenvalue* pressure_ = nullptr;
  const MphPairs<D>* pairs_ = nullptr;
  const CellRanges<Backend>* ranges_ = nullptr;
  WallTerms<D> terms_{};
  bool hasMatrixFree_ = false, hasAssembled_ = false;  // of this step
  GradientRows<D, Backend> rows_;
  BlockCsr<D, double, Backend> assembled_;
  MphOperator<D, Backend> matrixFree_;
  BucketLevels<Backend> levels_;
  SharedBuckets<Backend> shared_;  // where processes share the simulation, in place of them
  BlockCsr<D, double, Backend> bucketMatrix_, bucketPart_;  // A^0, and this process's part of it
  Buffer<Vec<D>, Backend> columns_;
  DeviceOnly<GalerkinSpgemm<D>, Backend> spgemm_;
  Buffer<Block<D>, Backend> diagonal_;
  Preconditioner<double> double_;
  Preconditioner<float> single_;
};

/// The linear solve of a step: A u = b with the operator, preconditioner and Krylov method of the case.
template <int D, class Backend = Cpu>
class MphSolver {
 public:
  /// Without any fallback.
  explicit MphSolver(const SolverSettings& settings) : MphSolver(std::vector{settings}) {}
  /// `stages`: of solveStages(); all with the same operator.
  explicit MphSolver(std::vector<SolverSettings> stages) : solver_(system_, std::move(stages)) {}
  MphSolver(const MphSolver&) = delete;

  /// Pair coefficients or matrix; all arguments must outlive the solves.
  void prepareOperator(Context<Backend>& context, const MphPairs<D>& pairs, const CellRanges<Backend>& ranges,
                       const WallTerms<D>& terms) {
    system_.setStep(pairs, ranges, terms);
    solver_.prepareOperator(context);
  }
  /// Diagonals and coarse operators. `pressure`: of the steps before, or none; the first stage uses and renews it.
  void preparePreconditioner(Context<Backend>& context, KeptEigenvalue* pressure = nullptr) {
    system_.keepEigenvalue(pressure);
    solver_.preparePreconditioner(context);
    system_.keepEigenvalue(nullptr);
  }

  /// `u`: first guess and solution, per fluid particle; `modes`, in the order of the fluid, and `history`: those
  /// of StagedSolver.
  StagedReport solve(Context<Backend>& context, std::span<const Vec<D>> b, std::span<Vec<D>> u,
                     SolverModes<D, Backend>* modes = nullptr, double* history = nullptr) {
    return solver_.solve(context, {reinterpret_cast<const double*>(b.data()), b.size() * D},
                         {reinterpret_cast<double*>(u.data()), u.size() * D}, modes, history);
  }

  std::size_t bytes() const { return system_.bytes() + solver_.bytes(); }

 private:
  MphSystem<D, Backend> system_;
  StagedSolver<D, Backend> solver_;
};

}  // namespace treacle
