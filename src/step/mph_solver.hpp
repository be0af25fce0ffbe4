#pragma once

#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/method/assemble.hpp"
#include "treacle/method/mph_operator.hpp"
#include "treacle/model/case.hpp"
#include "treacle/search/buckets.hpp"

#include <optional>

namespace treacle {

/// The linear solve of a step: A u = b with the operator, preconditioner and Krylov method of the case.
template <int D>
class MphSolver {
 public:
  explicit MphSolver(const SolverSettings& settings) : settings_(settings) {}

  /// Pair coefficients or matrix. `pairs` and the terms' spans must outlive the solve.
  void prepareOperator(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&);

  /// Diagonals and coarse operators. `key`: sort keys of the fluid particles.
  void preparePreconditioner(Context<Cpu>&, const MphPairs<D>&, const CellRanges<>&, const WallTerms<D>&);

  /// `u`: first guess and solution, per fluid particle.
  SolveReport solve(Context<Cpu>&, std::span<const Vec<D>> b, std::span<Vec<D>> u);

  std::size_t bytes() const;

 private:
  /// The data of K in the precision of the case.
  template <class T>
  struct Preconditioner {
    Buffer<Vec<D, T>> inverse;         // jacobi, and the particles of bucket-multigrid
    Buffer<Block<D, T>> blockInverse;  // block-jacobi
    BucketMultigrid<D, T> multigrid;   // bucket-multigrid
  };

  bool needsAssembled() const;
  template <class T>
  void prepare(Context<Cpu>&, const MphPairs<D>&, const CellRanges<>&, const WallTerms<D>&, Preconditioner<T>&);
  template <class T, class Operator>
  SolveReport solveWith(Context<Cpu>&, const Operator& a, Preconditioner<T>& k, std::span<const Vec<D>> b,
                        std::span<Vec<D>> u);
  template <class Operator, class Apply>
  SolveReport iterate(Context<Cpu>&, const Operator& a, const Apply& k, std::span<const Vec<D>> b,
                      std::span<Vec<D>> u);

  SolverSettings settings_;
  GradientRows<D> rows_;
  BlockCsr<D> assembled_, bucketMatrix_;
  MphOperator<D> matrixFree_;
  BucketLevels<> levels_;
  Buffer<Vec<D>> columns_;
  Buffer<Block<D>> diagonal_;
  Preconditioner<double> double_;
  Preconditioner<float> single_;
  KrylovWorkspace<> krylov_;
};

}  // namespace treacle
