#pragma once

#include "staged_report.hpp"
#include "treacle/linear/cell_multigrid.hpp"
#include "treacle/linear/krylov.hpp"
#include "treacle/precondition/isph_hat_multigrid.hpp"
#include "treacle/search/buckets.hpp"

#include <utility>
#include <vector>

namespace treacle {

/// A x = b for a matrix of pairs (ISPH's pressure and viscous step), with the Krylov method and the
/// preconditioner of the case. `Row`: PressureRow or ViscousRow.
template <int D, class Backend, class Row>
class PairSolver {
 public:
  /// `stages`: of solveStages().
  explicit PairSolver(std::vector<SolverSettings> stages) : stages_(std::move(stages)) {}

  /// The matrix; the first stage is next. `pairs` and what the row reads must outlive the solves.
  void prepareMatrix(Context<Backend>& context, const IsphPairs<D>& pairs, const Row& row) {
    stage_ = 0;
    pairs_ = &pairs;
    row_ = row;
    withPrecision([&](auto& data) { fill(context, data); });
  }
  /// `ranges` must outlive the solves.
  void preparePreconditioner(Context<Backend>& context, const CellRanges<Backend>& ranges) {
    ranges_ = &ranges;
    withPrecision([&](auto& data) { prepare(context, data); });
  }
  /// `x`: first guess and solution; what a row of zeros has there stays as it is. Several solves may follow each
  /// other with one matrix; a stage that failed is not tried again. `history`: StoppingRule's, of the last stage.
  StagedReport solve(Context<Backend>& context, std::span<const double> b, std::span<double> x,
                     double* history = nullptr) {
    history_ = history;
    keep(context, x);
    return solveInStages(
        stages_, stage_,
        [&] {
          SolveReport report;
          withPrecision([&](auto& data) { report = solveStage(context, data, b, x); });
          return report;
        },
        [&](const SolveReport& report) {
          if (isBetter(report)) return keep(context, x);
          copy(context, std::span<const double>(guess_), x);
        },
        [&] { withPrecision([&](auto& data) { fill(context, data), prepare(context, data); }); });
  }

  std::size_t bytes() const {
    std::size_t sum = diagonal_.bytes() + moments_.bytes() + compressed_.bytes() + levels_.bytes() +
                      guess_.bytes() + krylov_.bytes();
    const auto add = [&](const auto& data) {
      sum += data.coefficient.bytes() + data.word.bytes() + data.low.bytes() + data.inverseNear.bytes() +
             data.hats.bytes() + data.cells.bytes();
    };
    add(double_), add(single_);
    return sum;
  }

 private:
  static constexpr bool onDevice = std::is_same_v<Backend, Cuda>;

  /// The matrix and its preconditioner in the precision of a stage.
  template <class T>
  struct Data {
    Buffer<T, Backend> coefficient, inverseNear;
    Buffer<std::uint32_t, Backend> word;
    Buffer<std::uint16_t, Backend> low;
    IsphMatrix<T> matrix;
    IsphHatMultigrid<D, T, Backend> hats;
    CellMultigrid<T, Backend> cells;
  };

  const SolverSettings& stage() const { return stages_[stage_]; }

  template <class F>
  void withPrecision(F&& f) {
    if (stage().precision == Precision::Mixed)
      f(single_);
    else
      f(double_);
  }

  template <class T>
  void fill(Context<Backend>& context, Data<T>& data) {
    const NeighbourRowsView& rows = pairs_->fluidOfFluid;
    const std::size_t entries = pairs_->fluidEntries;
    const bool packed = onDevice && std::is_same_v<T, float> && rows.count <= PackedEntry::maxRows;
    data.coefficient.resize(context, packed ? 0 : entries);
    data.word.resize(context, packed ? entries : 0);
    data.low.resize(context, packed ? entries : 0);
    data.inverseNear.resize(context, rows.count);
    diagonal_.resize(context, rows.count);
    moments_.resize(context, rows.count);
    const double unit = row_.largest(*pairs_) / 255;
    fillIsphMatrix(
        context, *pairs_, row_,
        IsphMatrixParts<D, T>{data.coefficient, data.word, data.low, unit, diagonal_, data.inverseNear, moments_});
    data.matrix = {.rows = rows.count,
                   .start = rows.start,
                   .column = rows.column,
                   .coefficient = data.coefficient.data(),
                   .word = packed ? data.word.data() : nullptr,
                   .low = data.low.data(),
                   .unit = unit,
                   .diagonal = diagonal_.data(),
                   .inverseNear = data.inverseNear.data()};
  }

  template <class T>
  void prepare(Context<Backend>& context, Data<T>& data) {
    if (stage().preconditioner == PreconditionerKind::HatMultigrid)
      data.hats.setup(context, *pairs_, data.matrix, moments_, stage().hats.gridDegree);
    if (stage().preconditioner != PreconditionerKind::CellMultigrid) return;
    findBuckets(context, ranges_->key, D * CellGrid<D>::subBits, D, levels_);
    compressed(context, data.matrix, compressed_);
    data.cells.setup(context, compressed_, levels_.begin, stage().cells.levels, stage().cells.sweeps);
  }

  template <class T>
  SolveReport solveStage(Context<Backend>& context, Data<T>& data, std::span<const double> b,
                         std::span<double> x) {
    using Flat = std::span<const double>;
    const auto a = [&](Flat from, std::span<double> to) { multiply(context, data.matrix, from, to); };
    const auto with = [&](const auto& k) {
      const double refresh = stage().precision == Precision::Mixed ? 1e-4 : 0;
      const StoppingRule rule{stage().tolerance, stage().maxIterations, refresh, history_};
      return stage().krylov == KrylovKind::Cg ? conjugateGradient(context, a, k, b, x, rule, krylov_)
                                              : conjugateResidual(context, a, k, b, x, rule, krylov_);
    };
    switch (stage().preconditioner) {
      case PreconditionerKind::HatMultigrid:
        return with([&](Flat r, std::span<double> z) { data.hats.apply(context, r, z); });
      case PreconditionerKind::CellMultigrid:
        return with([&](Flat r, std::span<double> z) { data.cells.apply(context, r, z); });
      case PreconditionerKind::Jacobi:
        return with([&](Flat r, std::span<double> z) { jacobi(context, data.matrix, r, z); });
      default:
        return with([&](Flat r, std::span<double> z) { copy(context, r, z); });
    }
  }

  void keep(Context<Backend>& context, std::span<const double> x) {
    if (stage_ + 1 == stages_.size()) return;
    guess_.resize(context, x.size());
    copy(context, x, guess_.span());
  }

  std::vector<SolverSettings> stages_;
  std::size_t stage_ = 0;  // the one that is prepared
  const IsphPairs<D>* pairs_ = nullptr;
  const CellRanges<Backend>* ranges_ = nullptr;
  Row row_{};
  double* history_ = nullptr;
  Buffer<double, Backend> diagonal_;
  Buffer<IsphMoments<D>, Backend> moments_;
  BlockCsr<1, double, Backend> compressed_;
  BucketLevels<Backend> levels_;
  Buffer<double, Backend> guess_;  // the best one known, where there is a stage to fall back to
  Data<double> double_;
  Data<float> single_;
  KrylovWorkspace<Backend> krylov_;
};

}  // namespace treacle
