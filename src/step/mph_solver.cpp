#include "mph_solver.hpp"

#include "treacle/linear/diagonal.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

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
std::span<const double> flat(std::span<const Vec<D>> v) {
  return {reinterpret_cast<const double*>(v.data()), v.size() * D};
}
template <int D>
std::span<double> flat(std::span<Vec<D>> v) {
  return {reinterpret_cast<double*>(v.data()), v.size() * D};
}

template <int D>
ProjectionDegrees degreesOf(const ProjectedSettings& s, const MphPairs<D>& pairs) {
  return chooseDegrees({s.pressureDegree, s.gridDegree, s.velocityDegree}, projectionConstants(pairs));
}

}  // namespace

template <int D, class Backend>
bool MphSolver<D, Backend>::usesSpgemm() const {
  return onDevice && stage().preconditioner == PreconditionerKind::BucketMultigrid &&
         stage().multigrid.coarseOperators == CoarseKind::Spgemm;
}

template <int D, class Backend>
bool MphSolver<D, Backend>::needsAssembled() const {
  return stage().operatorKind == OperatorKind::Assembled || usesSpgemm() ||
         (stage().preconditioner == PreconditionerKind::BucketMultigrid &&
          stage().multigrid.particleDiagonal == SmootherDiagonal::ExtendedJacobi);
}

template <int D, class Backend>
void MphSolver<D, Backend>::prepareOperator(Context<Backend>& context, const MphPairs<D>& pairs,
                                            const WallTerms<D>& terms) {
  stage_ = 0;
  if (stage().operatorKind == OperatorKind::MatrixFree ||
      stage().preconditioner == PreconditionerKind::ProjectedMultigrid)
    matrixFree_.prepare(context, pairs, terms);
  if (!needsAssembled()) return;
  gradientRows(context, pairs, rows_);
  assemble(context, pairs, terms, rows_, assembled_);
}

template <int D, class Backend>
void MphSolver<D, Backend>::preparePreconditioner(Context<Backend>& context, const MphPairs<D>& pairs,
                                                  const CellRanges<Backend>& ranges, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  ranges_ = &ranges;
  terms_ = terms;
  prepareStage(context);
}

template <int D, class Backend>
void MphSolver<D, Backend>::prepareStage(Context<Backend>& context) {
  if (stage().precision == Precision::Mixed)
    prepare(context, *pairs_, *ranges_, terms_, single_);
  else
    prepare(context, *pairs_, *ranges_, terms_, double_);
}

template <int D, class Backend>
template <class T>
void MphSolver<D, Backend>::prepare(Context<Backend>& context, const MphPairs<D>& pairs,
                                    const CellRanges<Backend>& ranges, const WallTerms<D>& terms,
                                    Preconditioner<T>& k) {
  if (stage().preconditioner == PreconditionerKind::None) return;
  if (stage().preconditioner == PreconditionerKind::ProjectedMultigrid)
    return k.projected.setup(context, pairs, terms, matrixFree_, degreesOf(stage().projected, pairs));
  diagonal_.resize(context, pairs.fluidCount);
  diagonalBlocks<D>(context, pairs, terms, diagonal_);
  if (stage().preconditioner == PreconditionerKind::BlockJacobi) {
    k.blockInverse.resize(context, pairs.fluidCount);
    blockInverse<D, T>(context, diagonal_, k.blockInverse);
    return;
  }
  k.inverse.resize(context, pairs.fluidCount);
  jacobiInverse<D, T>(context, diagonal_, k.inverse);
  if (stage().preconditioner == PreconditionerKind::BucketMultigrid)
    prepareMultigrid(context, pairs, ranges, terms, k);
}

template <int D, class Backend>
template <class T>
void MphSolver<D, Backend>::prepareMultigrid(Context<Backend>& context, const MphPairs<D>& pairs,
                                             const CellRanges<Backend>& ranges, const WallTerms<D>& terms,
                                             Preconditioner<T>& k) {
  const MultigridSettings& m = stage().multigrid;
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
StagedReport MphSolver<D, Backend>::solve(Context<Backend>& context, std::span<const Vec<D>> b,
                                          std::span<Vec<D>> u, SolverModes<D, Backend>* modes, double* history) {
  modes_ = modes;
  history_ = history;
  if (modes_ && !deflates(0)) modes_->drop();  // of a state that another solver made
  if (stage_ + 1 < stages_.size()) {
    guess_.resize(context, u.size());
    copy(context, flat<D>(u), flat<D>(guess_.span()));
  }
  return solveInStages(
      stages_, stage_, [&] { return solveStage(context, b, u); },
      [&](const SolveReport& report) { keepBetter(context, report, u); }, [&] { prepareStage(context); });
}

/// Of the guess that a stage started from and what it made of it.
template <int D, class Backend>
void MphSolver<D, Backend>::keepBetter(Context<Backend>& context, const SolveReport& report, std::span<Vec<D>> u) {
  if (isBetter(report))
    copy(context, flat<D>(u), flat<D>(guess_.span()));
  else
    copy(context, flat<D>(guess_.span()), flat<D>(u));
}

template <int D, class Backend>
SolveReport MphSolver<D, Backend>::solveStage(Context<Backend>& context, std::span<const Vec<D>> b,
                                              std::span<Vec<D>> u) {
  const auto matrixFree = [&](std::span<const double> x, std::span<double> y) {
    matrixFree_.multiply(context, asVectors<D>(x), asVectors<D>(y));
  };
  const auto assembled = [&](std::span<const double> x, std::span<double> y) {
    multiply<D, double>(context, assembled_, asVectors<D>(x), asVectors<D>(y));
  };
  const auto withOperator = [&](const auto& a) {
    return stage().precision == Precision::Mixed ? solveWith(context, a, single_, b, u)
                                                 : solveWith(context, a, double_, b, u);
  };
  return stage().operatorKind == OperatorKind::Assembled ? withOperator(assembled) : withOperator(matrixFree);
}

template <int D, class Backend>
template <class T, class Operator>
SolveReport MphSolver<D, Backend>::solveWith(Context<Backend>& context, const Operator& a, Preconditioner<T>& k,
                                             std::span<const Vec<D>> b, std::span<Vec<D>> u) {
  using Flat = std::span<const double>;
  switch (stage().preconditioner) {
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
    case PreconditionerKind::ProjectedMultigrid:
      return iterate(
          context, a,
          [&](Flat r, std::span<double> z) { k.projected.apply(context, asVectors<D>(r), asVectors<D>(z)); }, b,
          u);
    default:
      break;
  }
  return iterate(
      context, a, [&](Flat r, std::span<double> z) { copy(context, r, z); }, b, u);
}

template <int D, class Backend>
template <class Operator, class Apply>
SolveReport MphSolver<D, Backend>::iterate(Context<Backend>& context, const Operator& a, const Apply& k,
                                           std::span<const Vec<D>> b, std::span<Vec<D>> u) {
  const double refresh = stage().precision == Precision::Mixed ? 1e-4 : 0;
  const StoppingRule rule{stage().tolerance, stage().maxIterations, refresh, history_};
  if (stage().krylov == KrylovKind::Cr)
    return conjugateResidual(context, a, k, flat<D>(b), flat<D>(u), rule, krylov_);
  if (!modes_ || !deflates(stage_)) return conjugateGradient(context, a, k, flat<D>(b), flat<D>(u), rule, krylov_);
  Deflation<Backend>& deflation = keeper_.prepare(context, *modes_, u.size(), stage().deflation);
  const SolveReport report = conjugateGradient(context, a, k, flat<D>(b), flat<D>(u), rule, krylov_, deflation);
  keeper_.finish(context, *modes_, report, stage().deflation);
  return report;
}

template <int D, class Backend>
bool MphSolver<D, Backend>::deflates(std::size_t stage) const {
  const SolverSettings& s = stages_[stage];
  return stage == 0 && s.deflation > 0 && s.krylov == KrylovKind::Cg &&
         s.preconditioner == PreconditionerKind::ProjectedMultigrid;
}

template <int D, class Backend>
std::size_t MphSolver<D, Backend>::bytes() const {
  std::size_t sum = rows_.bytes() + assembled_.bytes() + bucketMatrix_.bytes() + matrixFree_.bytes() +
                    levels_.bytes() + columns_.bytes() + diagonal_.bytes() + krylov_.bytes() + guess_.bytes() +
                    keeper_.bytes();
  const auto add = [&](const auto& k) {
    sum += k.inverse.bytes() + k.blockInverse.bytes() + k.multigrid.bytes() + k.projected.bytes();
  };
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
