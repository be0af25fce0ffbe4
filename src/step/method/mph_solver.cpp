#include "mph_solver.hpp"

#include "treacle/linear/diagonal.hpp"
#include "treacle/linear/joined_rows.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"
#include "treacle/step/method/solve_stages.hpp"

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

template <int D>
ProjectionDegrees degreesOf(const ProjectedSettings& s, const MphPairs<D>& pairs) {
  return chooseDegrees({s.pressureDegree, s.gridDegree, s.velocityDegree}, projectionConstants(pairs));
}

/// Whether coarse operators are products of sparse matrices, which there are on devices alone.
template <class Backend>
bool usesSpgemm(const SolverSettings& stage) {
  return std::is_same_v<Backend, Cuda> && stage.preconditioner == PreconditionerKind::BucketMultigrid &&
         stage.multigrid.coarseOperators == CoarseKind::Spgemm;
}

bool needsMatrixFree(const SolverSettings& stage) {
  return stage.operatorKind == OperatorKind::MatrixFree ||
         stage.preconditioner == PreconditionerKind::ProjectedMultigrid;
}

}  // namespace

template <class Backend>
bool needsAssembled(const SolverSettings& stage) {
  return stage.operatorKind == OperatorKind::Assembled || usesSpgemm<Backend>(stage) ||
         (stage.preconditioner == PreconditionerKind::BucketMultigrid &&
          stage.multigrid.particleDiagonal == SmootherDiagonal::ExtendedJacobi);
}

template <int D, class Backend>
void MphSystem<D, Backend>::setStep(const MphPairs<D>& pairs, const CellRanges<Backend>& ranges,
                                    const WallTerms<D>& terms) {
  pairs_ = &pairs;
  ranges_ = &ranges;
  terms_ = terms;
  hasMatrixFree_ = hasAssembled_ = false;
}

template <int D, class Backend>
void MphSystem<D, Backend>::prepareOperator(Context<Backend>& context, const SolverSettings& stage) {
  stage_ = stage;
  if (needsMatrixFree(stage) && !hasMatrixFree_) {
    matrixFree_.prepare(context, *pairs_, terms_);
    hasMatrixFree_ = true;
  }
  if (needsAssembled<Backend>(stage) && !hasAssembled_) {
    gradientRows(context, *pairs_, rows_);
    assemble(context, *pairs_, terms_, rows_, assembled_);
    giveUp(rows_.rowStart, rows_.column, rows_.value);
    hasAssembled_ = true;
  }
}

template <int D, class Backend>
template <class F>
void MphSystem<D, Backend>::withPrecision(F&& f) {
  if (stage_.precision == Precision::Mixed)
    f(single_);
  else
    f(double_);
}

template <int D, class Backend>
void MphSystem<D, Backend>::preparePreconditioner(Context<Backend>& context, const SolverSettings&) {
  withPrecision([&](auto& k) { prepare(context, k); });
}

template <int D, class Backend>
template <class T>
void MphSystem<D, Backend>::prepare(Context<Backend>& context, Preconditioner<T>& k) {
  if (stage_.preconditioner == PreconditionerKind::None) return;
  if (stage_.preconditioner == PreconditionerKind::ProjectedMultigrid)
    return k.projected.setup(context, *pairs_, terms_, matrixFree_, degreesOf(stage_.projected, *pairs_),
                             pressure_, mostWholeNodes(stage_, context));
  diagonal_.resize(context, pairs_->ownFluid());
  diagonalBlocks<D>(context, *pairs_, terms_, diagonal_);
  if (stage_.preconditioner == PreconditionerKind::BlockJacobi) {
    k.blockInverse.resize(context, pairs_->ownFluid());
    blockInverse<D, T>(context, diagonal_, k.blockInverse);
    return;
  }
  k.inverse.resize(context, pairs_->ownFluid());
  jacobiInverse<D, T>(context, diagonal_, k.inverse);
  if (stage_.preconditioner == PreconditionerKind::BucketMultigrid) prepareMultigrid(context, k);
}

template <int D, class Backend>
template <class T>
void MphSystem<D, Backend>::prepareMultigrid(Context<Backend>& context, Preconditioner<T>& k) {
  const MultigridSettings& m = stage_.multigrid;
  if (m.particleDiagonal == SmootherDiagonal::ExtendedJacobi)
    extendedJacobiInverse<D, double, T>(context, assembled_, k.inverse);
  const CycleSweeps sweeps{m.finestSweeps, m.middleSweeps, m.coarsestSweeps};
  if (context.halo) {
    findSharedBuckets(context, *pairs_, ranges_->key, shared_);
    bucketGalerkin(context, *pairs_, *ranges_, shared_.local, terms_, columns_, bucketPart_);
    giveUp(columns_);
    joinRows<D>(context, bucketPart_, {shared_.all.count(0), shared_.own, shared_.number}, bucketMatrix_);
    k.multigrid.setup(context, bucketMatrix_, {shared_.all.begin.begin(), shared_.all.begin.end()}, sweeps);
    return;
  }
  findBuckets(context, ranges_->key, D * CellGrid<D>::subBits, D, levels_);
  std::vector<std::span<const std::uint32_t>> members(levels_.begin.begin(), levels_.begin.end());
  if constexpr (std::is_same_v<Backend, Cuda>) {
    if (usesSpgemm<Backend>(stage_)) {
      spgemm_.compute(context, assembled_, members[0], bucketMatrix_);
      k.multigrid.setup(context, bucketMatrix_, std::move(members), sweeps, &spgemm_);
      return;
    }
  }
  bucketGalerkin(context, *pairs_, *ranges_, levels_, terms_, columns_, bucketMatrix_);
  giveUp(columns_);
  k.multigrid.setup(context, bucketMatrix_, std::move(members), sweeps);
}

template <int D, class Backend>
void MphSystem<D, Backend>::multiply(Context<Backend>& context, std::span<const double> x, std::span<double> y) {
  if (stage_.operatorKind == OperatorKind::Assembled)
    treacle::multiply<D, double>(context, assembled_, asVectors<D>(x), asVectors<D>(y));
  else
    matrixFree_.multiply(context, asVectors<D>(x), asVectors<D>(y));
}

template <int D, class Backend>
void MphSystem<D, Backend>::precondition(Context<Backend>& context, std::span<const double> flatR,
                                         std::span<double> flatZ) {
  const auto r = asVectors<D>(flatR);
  const auto z = asVectors<D>(flatZ);
  withPrecision([&]<class T>(Preconditioner<T>& k) {
    switch (stage_.preconditioner) {
      case PreconditionerKind::Jacobi:
        return applyDiagonal<D, T>(context, k.inverse, r, z);
      case PreconditionerKind::BlockJacobi:
        return applyBlockDiagonal<D, T>(context, k.blockInverse, r, z);
      case PreconditionerKind::BucketMultigrid:
        return k.multigrid.apply(context, k.inverse, r, z);
      case PreconditionerKind::ProjectedMultigrid:
        return k.projected.apply(context, r, z);
      default:
        return copy(context, flatR, flatZ);
    }
  });
}

template <int D, class Backend>
std::size_t MphSystem<D, Backend>::bytes() const {
  std::size_t sum = rows_.bytes() + assembled_.bytes() + bucketMatrix_.bytes() + bucketPart_.bytes() +
                    matrixFree_.bytes() + levels_.bytes() + shared_.bytes() + columns_.bytes() + spgemm_.bytes() +
                    diagonal_.bytes();
  const auto add = [&](const auto& k) {
    sum += k.inverse.bytes() + k.blockInverse.bytes() + k.multigrid.bytes() + k.projected.bytes();
  };
  add(double_), add(single_);
  return sum;
}

#define TREACLE_INSTANTIATE(Backend)                            \
  template bool needsAssembled<Backend>(const SolverSettings&); \
  template class MphSystem<2, Backend>;                         \
  template class MphSystem<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
