#pragma once

#include "mode_keeper.hpp"
#include "staged_report.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/model/case.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/precondition/projected_multigrid.hpp"
#include "treacle/search/buckets.hpp"

#include <type_traits>
#include <vector>

namespace treacle {

/// The linear solve of a step: A u = b with the operator, preconditioner and Krylov method of the case.
template <int D, class Backend = Cpu>
class MphSolver {
 public:
  /// Without any fallback.
  explicit MphSolver(const SolverSettings& settings) : stages_{settings} {}
  /// `stages`: of solveStages(); all with the same operator.
  explicit MphSolver(std::vector<SolverSettings> stages) : stages_(std::move(stages)) {}

  /// Pair coefficients or matrix; the first stage is next. `pairs` and the terms' spans must outlive the solve.
  void prepareOperator(Context<Backend>&, const MphPairs<D>&, const WallTerms<D>&);

  /// Diagonals and coarse operators. All arguments must outlive the solve, which may come back to them.
  void preparePreconditioner(Context<Backend>&, const MphPairs<D>&, const CellRanges<Backend>&,
                             const WallTerms<D>&);

  /// `u`: first guess and solution, per fluid particle. A stage that fails is followed by the next one, from the
  /// best guess there is. The first one is deflated by `modes`, in the order of the fluid, and takes them anew
  /// when they are due; a failure drops them. Null: no solve is deflated. `history`: StoppingRule's, of the last
  /// stage.
  StagedReport solve(Context<Backend>&, std::span<const Vec<D>> b, std::span<Vec<D>> u,
                     SolverModes<D, Backend>* modes = nullptr, double* history = nullptr);

  std::size_t bytes() const;

 private:
  /// The data of K in the precision of the case.
  template <class T>
  struct Preconditioner {
    Buffer<Vec<D, T>, Backend> inverse;         // jacobi, and the particles of bucket-multigrid
    Buffer<Block<D, T>, Backend> blockInverse;  // block-jacobi
    BucketMultigrid<D, T, Backend> multigrid;   // bucket-multigrid
    ProjectedMultigrid<D, T, Backend> projected;
  };

  static constexpr bool onDevice = std::is_same_v<Backend, Cuda>;
  struct Nothing {};

  const SolverSettings& stage() const { return stages_[stage_]; }
  bool usesSpgemm() const;
  bool needsAssembled() const;
  void prepareStage(Context<Backend>&);
  SolveReport solveStage(Context<Backend>&, std::span<const Vec<D>> b, std::span<Vec<D>> u);
  void keepBetter(Context<Backend>&, const SolveReport&, std::span<Vec<D>> u);
  template <class T>
  void prepareMultigrid(Context<Backend>&, const MphPairs<D>&, const CellRanges<Backend>&, const WallTerms<D>&,
                        Preconditioner<T>&);
  template <class T>
  void prepare(Context<Backend>&, const MphPairs<D>&, const CellRanges<Backend>&, const WallTerms<D>&,
               Preconditioner<T>&);
  template <class T, class Operator>
  SolveReport solveWith(Context<Backend>&, const Operator& a, Preconditioner<T>& k, std::span<const Vec<D>> b,
                        std::span<Vec<D>> u);
  template <class Operator, class Apply>
  SolveReport iterate(Context<Backend>&, const Operator& a, const Apply& k, std::span<const Vec<D>> b,
                      std::span<Vec<D>> u);
  bool deflates(std::size_t stage) const;

  std::vector<SolverSettings> stages_;
  std::size_t stage_ = 0;  // the one that is prepared
  const MphPairs<D>* pairs_ = nullptr;
  const CellRanges<Backend>* ranges_ = nullptr;
  WallTerms<D> terms_{};
  Buffer<Vec<D>, Backend> guess_;  // the best one known, where there is a stage to fall back to
  GradientRows<D, Backend> rows_;
  BlockCsr<D, double, Backend> assembled_;
  MphOperator<D, Backend> matrixFree_;
  BucketLevels<Backend> levels_;
  BlockCsr<D, double, Backend> bucketMatrix_;  // A^0
  Buffer<Vec<D>, Backend> columns_;
  std::conditional_t<onDevice, GalerkinSpgemm<D>, Nothing> spgemm_;
  Buffer<Block<D>, Backend> diagonal_;
  Preconditioner<double> double_;
  Preconditioner<float> single_;
  KrylovWorkspace<Backend> krylov_;
  ModeKeeper<D, Backend> keeper_;
  SolverModes<D, Backend>* modes_ = nullptr;
  double* history_ = nullptr;
};

}  // namespace treacle
