#pragma once

#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/method/assemble.hpp"
#include "treacle/method/mph_operator.hpp"
#include "treacle/model/case.hpp"
#include "treacle/search/buckets.hpp"

#include <type_traits>

namespace treacle {

/// The linear solve of a step: A u = b with the operator, preconditioner and Krylov method of the case.
template <int D, class Backend = Cpu>
class MphSolver {
 public:
  explicit MphSolver(const SolverSettings& settings) : settings_(settings) {}

  /// Pair coefficients or matrix. `pairs` and the terms' spans must outlive the solve.
  void prepareOperator(Context<Backend>&, const MphPairs<D>&, const WallTerms<D>&);

  /// Diagonals and coarse operators.
  void preparePreconditioner(Context<Backend>&, const MphPairs<D>&, const CellRanges<Backend>&,
                             const WallTerms<D>&);

  /// `u`: first guess and solution, per fluid particle.
  SolveReport solve(Context<Backend>&, std::span<const Vec<D>> b, std::span<Vec<D>> u);

  std::size_t bytes() const;

 private:
  /// The data of K in the precision of the case.
  template <class T>
  struct Preconditioner {
    Buffer<Vec<D, T>, Backend> inverse;         // jacobi, and the particles of bucket-multigrid
    Buffer<Block<D, T>, Backend> blockInverse;  // block-jacobi
    BucketMultigrid<D, T, Backend> multigrid;   // bucket-multigrid
  };

  static constexpr bool onDevice = std::is_same_v<Backend, Cuda>;
  struct Nothing {};

  bool usesSpgemm() const;
  bool needsAssembled() const;
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

  SolverSettings settings_;
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
};

}  // namespace treacle
