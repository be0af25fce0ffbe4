#include "mph_solver.hpp"

#include "treacle/linear/diagonal.hpp"
#include "treacle/method/bucket_galerkin.hpp"

namespace treacle {
namespace {

/// Krylov vectors are flat; the sums work on one Vec per particle.
template <int D>
std::span<const Vec<D>> asVectors(std::span<const double> flat) {
  return {reinterpret_cast<const Vec<D>*>(flat.data()), flat.size() / D};
}
template <int D>
std::span<Vec<D>> asVectors(std::span<double> flat) {
  return {reinterpret_cast<Vec<D>*>(flat.data()), flat.size() / D};
}

}  // namespace

template <int D, class Backend>
bool MphSolver<D, Backend>::usesSpgemm() const {
  return onDevice && settings_.preconditioner == PreconditionerKind::BucketMultigrid &&
         settings_.multigrid.coarseOperators == CoarseKind::Spgemm;
}

template <int D, class Backend>
bool MphSolver<D, Backend>::needsAssembled() const {
  return settings_.operatorKind == OperatorKind::Assembled || usesSpgemm() ||
         (settings_.preconditioner == PreconditionerKind::BucketMultigrid &&
          settings_.multigrid.particleDiagonal == SmootherDiagonal::ExtendedJacobi);
}

template <int D, class Backend>
void MphSolver<D, Backend>::prepareOperator(Context<Backend>& context, const MphPairs<D>& pairs,
                                            const WallTerms<D>& terms) {
  if (settings_.operatorKind == OperatorKind::MatrixFree) matrixFree_.prepare(context, pairs, terms);
  if (!needsAssembled()) return;
  gradientRows(context, pairs, rows_);
  assemble(context, pairs, terms, rows_, assembled_);
}

template <int D, class Backend>
void MphSolver<D, Backend>::preparePreconditioner(Context<Backend>& context, const MphPairs<D>& pairs,
                                                  const CellRanges<Backend>& ranges, const WallTerms<D>& terms) {
  if (settings_.precision == Precision::Mixed)
    prepare(context, pairs, ranges, terms, single_);
  else
    prepare(context, pairs, ranges, terms, double_);
}

template <int D, class Backend>
template <class T>
void MphSolver<D, Backend>::prepare(Context<Backend>& context, const MphPairs<D>& pairs,
                                    const CellRanges<Backend>& ranges, const WallTerms<D>& terms,
                                    Preconditioner<T>& k) {
  if (settings_.preconditioner == PreconditionerKind::None) return;
  diagonal_.resize(context, pairs.fluidCount);
  diagonalBlocks<D>(context, pairs, terms, diagonal_);
  if (settings_.preconditioner == PreconditionerKind::BlockJacobi) {
    k.blockInverse.resize(context, pairs.fluidCount);
    blockInverse<D, T>(context, diagonal_, k.blockInverse);
    return;
  }
  k.inverse.resize(context, pairs.fluidCount);
  jacobiInverse<D, T>(context, diagonal_, k.inverse);
  if (settings_.preconditioner == PreconditionerKind::BucketMultigrid)
    prepareMultigrid(context, pairs, ranges, terms, k);
}

template <int D, class Backend>
template <class T>
void MphSolver<D, Backend>::prepareMultigrid(Context<Backend>& context, const MphPairs<D>& pairs,
                                             const CellRanges<Backend>& ranges, const WallTerms<D>& terms,
                                             Preconditioner<T>& k) {
  const MultigridSettings& m = settings_.multigrid;
  if (m.particleDiagonal == SmootherDiagonal::ExtendedJacobi)
    extendedJacobiInverse<D, double, T>(context, assembled_, k.inverse);
  findBuckets(context, ranges.key, D * CellGrid<D>::subBits, D, levels_);
  std::vector<std::span<const std::uint32_t>> members(levels_.begin.begin(), levels_.begin.end());
  const CycleSweeps sweeps{m.finestSweeps, m.middleSweeps, m.coarsestSweeps};
  if constexpr (onDevice) {
    if (usesSpgemm()) {
      spgemm_.compute(context, assembled_, members[0], bucketMatrix_);
      k.multigrid.setup(context, bucketMatrix_, std::move(members), sweeps, &spgemm_);
      return;
    }
  }
  bucketGalerkin(context, pairs, ranges, levels_, terms, columns_, bucketMatrix_);
  k.multigrid.setup(context, bucketMatrix_, std::move(members), sweeps);
}

template <int D, class Backend>
SolveReport MphSolver<D, Backend>::solve(Context<Backend>& context, std::span<const Vec<D>> b,
                                         std::span<Vec<D>> u) {
  const auto matrixFree = [&](std::span<const double> x, std::span<double> y) {
    matrixFree_.multiply(context, asVectors<D>(x), asVectors<D>(y));
  };
  const auto assembled = [&](std::span<const double> x, std::span<double> y) {
    multiply<D, double>(context, assembled_, asVectors<D>(x), asVectors<D>(y));
  };
  const auto withOperator = [&](const auto& a) {
    return settings_.precision == Precision::Mixed ? solveWith(context, a, single_, b, u)
                                                   : solveWith(context, a, double_, b, u);
  };
  return settings_.operatorKind == OperatorKind::Assembled ? withOperator(assembled) : withOperator(matrixFree);
}

template <int D, class Backend>
template <class T, class Operator>
SolveReport MphSolver<D, Backend>::solveWith(Context<Backend>& context, const Operator& a, Preconditioner<T>& k,
                                             std::span<const Vec<D>> b, std::span<Vec<D>> u) {
  using Flat = std::span<const double>;
  switch (settings_.preconditioner) {
    case PreconditionerKind::Jacobi:
      return iterate(
          context, a,
          [&](Flat r, std::span<double> z) {
            applyDiagonal<D, T>(context, k.inverse, asVectors<D>(r), asVectors<D>(z));
          },
          b, u);
    case PreconditionerKind::BlockJacobi:
      return iterate(
          context, a,
          [&](Flat r, std::span<double> z) {
            applyBlockDiagonal<D, T>(context, k.blockInverse, asVectors<D>(r), asVectors<D>(z));
          },
          b, u);
    case PreconditionerKind::BucketMultigrid:
      return iterate(
          context, a,
          [&](Flat r, std::span<double> z) {
            k.multigrid.apply(context, k.inverse, asVectors<D>(r), asVectors<D>(z));
          },
          b, u);
    case PreconditionerKind::None:
      break;
  }
  return iterate(
      context, a, [&](Flat r, std::span<double> z) { copy(context, r, z); }, b, u);
}

template <int D, class Backend>
template <class Operator, class Apply>
SolveReport MphSolver<D, Backend>::iterate(Context<Backend>& context, const Operator& a, const Apply& k,
                                           std::span<const Vec<D>> b, std::span<Vec<D>> u) {
  const std::span<const double> rhs(reinterpret_cast<const double*>(b.data()), b.size() * D);
  const std::span<double> x(reinterpret_cast<double*>(u.data()), u.size() * D);
  const double refresh = settings_.precision == Precision::Mixed ? 1e-4 : 0;
  const StoppingRule rule{settings_.tolerance, settings_.maxIterations, refresh};
  return settings_.krylov == KrylovKind::Cg ? conjugateGradient(context, a, k, rhs, x, rule, krylov_)
                                            : conjugateResidual(context, a, k, rhs, x, rule, krylov_);
}

template <int D, class Backend>
std::size_t MphSolver<D, Backend>::bytes() const {
  std::size_t sum = rows_.bytes() + assembled_.bytes() + bucketMatrix_.bytes() + matrixFree_.bytes() +
                    levels_.bytes() + columns_.bytes() + diagonal_.bytes() + krylov_.bytes();
  const auto add = [&](const auto& k) { sum += k.inverse.bytes() + k.blockInverse.bytes() + k.multigrid.bytes(); };
  add(double_), add(single_);
  return sum;
}

template class MphSolver<2, Cpu>;
template class MphSolver<3, Cpu>;
#ifdef TREACLE_HAS_CUDA
template class MphSolver<2, Cuda>;
template class MphSolver<3, Cuda>;
#endif

}  // namespace treacle
