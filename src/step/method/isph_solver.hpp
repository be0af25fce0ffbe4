#pragma once

#include "staged_solver.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/linear/cell_multigrid.hpp"
#include "treacle/precondition/isph_hat_multigrid.hpp"
#include "treacle/search/shared_buckets.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

/// The pressure equation of ISPH or its implicit viscous step: a matrix of pairs and its preconditioners. `Row`:
/// PressureRow or ViscousRow.
template <int D, class Backend, class Row>
class IsphSystem final : public StagedSystem<Backend> {
 public:
  /// What the matrix of a step is made of; it must outlive the solves.
  void setStep(const IsphPairs<D>& pairs, const CellRanges<Backend>& ranges, const Row& row) {
    pairs_ = &pairs;
    ranges_ = &ranges;
    row_ = row;
  }

  void prepareOperator(Context<Backend>& context, const SolverSettings& stage) override {
    stage_ = stage;
    withPrecision([&](auto& data) { fill(context, data); });
  }
  void preparePreconditioner(Context<Backend>& context, const SolverSettings&) override {
    withPrecision([&](auto& data) { prepare(context, data); });
  }
  void multiply(Context<Backend>& context, std::span<const double> own, std::span<double> y) override {
    const std::span<const double> x = withGhosts(context, own, withGhosts_);
    withPrecision([&](auto& data) { treacle::multiply(context, data.matrix, x, y); });
  }
  void precondition(Context<Backend>& context, std::span<const double> r, std::span<double> z) override {
    withPrecision([&](auto& data) {
      switch (stage_.preconditioner) {
        case PreconditionerKind::HatMultigrid:
          return data.hats.apply(context, r, z);
        case PreconditionerKind::CellMultigrid:
          return data.cells.apply(context, r, z);
        case PreconditionerKind::Jacobi:
          return jacobi(context, data.matrix, r, z);
        default:
          return copy(context, r, z);
      }
    });
  }

  /// Over hundreds of iterations rounded directions lose sight of each other; here there are few.
  bool likesSingle() const override {
    return stage_.precision == Precision::Mixed && stage_.preconditioner == PreconditionerKind::HatMultigrid;
  }
  void multiplySingle(Context<Backend>& context, std::span<const double> own, std::span<double> y) override {
    const std::span<const double> x = withGhosts(context, own, withGhosts_);
    withPrecision([&](auto& data) { treacle::multiplySingle(context, data.matrix, x, y); });
  }

  std::size_t bytes() const {
    std::size_t sum = diagonal_.bytes() + moments_.bytes() + withGhosts_.bytes() + compressed_.bytes() +
                      levels_.bytes() + shared_.bytes();
    const auto add = [&](const auto& data) {
      sum += data.coefficient.bytes() + data.packed.bytes() + data.inverseNear.bytes() + data.hats.bytes() +
             data.cells.bytes();
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
    PackedEntries<Backend> packed;
    IsphMatrix<T> matrix;
    IsphHatMultigrid<D, T, Backend> hats;
    CellMultigrid<T, Backend> cells;
  };

  template <class F>
  void withPrecision(F&& f) {
    if (stage_.precision == Precision::Mixed)
      f(single_);
    else
      f(double_);
  }

  /// The mean number of rows of a process. Either all processes pack their rows or none does: a coefficient stands
  /// in the rows of two particles, and must be the same in both.
  static std::uint64_t meanRows(const Context<Backend>& context, std::uint32_t own) {
    return context.halo ? context.halo->fluidOfAll / context.communicator->size() : own;
  }

  template <class T>
  void fill(Context<Backend>& context, Data<T>& data) {
    const NeighbourRowsView& rows = pairs_->fluidOfFluid;
    PackedEntriesView packed;
    if constexpr (onDevice && std::is_same_v<T, float>)
      if (meanRows(context, rows.count) >= PackedEntries<Backend>::fewest) {
        preparePacked(context, *pairs_, data.packed);
        packed = data.packed.view();
      }
    data.coefficient.resize(context, packed.word ? 0 : pairs_->fluidEntries);
    data.inverseNear.resize(context, rows.count);
    diagonal_.resize(context, rows.count);
    moments_.resize(context, rows.count);
    const double unit = row_.largest(*pairs_) / 255;
    fillIsphMatrix(context, *pairs_, row_,
                   IsphMatrixParts<D, T>{data.coefficient, packed, unit, diagonal_, data.inverseNear, moments_});
    data.matrix = {.rows = rows.count,
                   .start = rows.start,
                   .column = rows.column,
                   .coefficient = data.coefficient.data(),
                   .packed = packed,
                   .unit = unit,
                   .diagonal = diagonal_.data(),
                   .inverseNear = data.inverseNear.data()};
  }

  template <class T>
  void prepare(Context<Backend>& context, Data<T>& data) {
    if (stage_.preconditioner == PreconditionerKind::HatMultigrid)
      data.hats.setup(context, *pairs_, data.matrix, moments_, stage_.hats.gridDegree,
                      mostWholeNodes(stage_, context));
    giveUp(moments_);
    if (stage_.preconditioner != PreconditionerKind::CellMultigrid) return;
    compressed(context, data.matrix, pairs_->fluidCount, compressed_);
    if (context.halo) {
      findSharedBuckets(context, *pairs_, ranges_->key, shared_);
      const typename CellMultigrid<T, Backend>::SharedCells shared{
          shared_.local.begin[0], {shared_.all.count(0), shared_.own, shared_.number}};
      data.cells.setup(context, compressed_, severalCells(shared_.all), stage_.cells.levels, stage_.cells.sweeps,
                       &shared);
    } else {
      findBuckets(context, ranges_->key, D * CellGrid<D>::subBits, D, levels_);
      data.cells.setup(context, compressed_, severalCells(levels_), stage_.cells.levels, stage_.cells.sweeps);
    }
  }

  /// The levels that have more than one cell, at least the first. Without a free surface pressures are known up to
  /// a constant, and the matrix of one cell is nothing but rounding.
  static std::span<const Buffer<std::uint32_t, Backend>> severalCells(const BucketLevels<Backend>& levels) {
    std::size_t count = levels.begin.size();
    while (count > 1 && levels.count(count - 1) == 1) --count;
    return std::span(levels.begin).first(count);
  }

  SolverSettings stage_;  // the one that is prepared
  const IsphPairs<D>* pairs_ = nullptr;
  const CellRanges<Backend>* ranges_ = nullptr;
  Row row_{};
  Buffer<double, Backend> diagonal_;
  Buffer<IsphMoments<D>, Backend> moments_;
  Buffer<double, Backend> withGhosts_;  // what is multiplied
  BlockCsr<1, double, Backend> compressed_;
  BucketLevels<Backend> levels_;
  SharedBuckets<Backend> shared_;  // where processes share the simulation, in place of them
  Data<double> double_;
  Data<float> single_;
};

/// A x = b for such a matrix, with the Krylov method and the preconditioner of the case.
template <int D, class Backend, class Row>
class IsphSolver {
 public:
  /// `stages`: of solveStages().
  explicit IsphSolver(std::vector<SolverSettings> stages) : solver_(system_, std::move(stages)) {}
  IsphSolver(const IsphSolver&) = delete;

  /// The matrix; all arguments, and what the row reads, must outlive the solves.
  void prepareMatrix(Context<Backend>& context, const IsphPairs<D>& pairs, const CellRanges<Backend>& ranges,
                     const Row& row) {
    system_.setStep(pairs, ranges, row);
    solver_.prepareOperator(context);
  }
  /// Once for each matrix that is prepared.
  void preparePreconditioner(Context<Backend>& context) { solver_.preparePreconditioner(context); }

  /// `x`: first guess and solution; what a row of zeros has there stays as it is. The rest: StagedSolver.
  StagedReport solve(Context<Backend>& context, std::span<const double> b, std::span<double> x,
                     double* history = nullptr, double looser = 1) {
    return solver_.solve(context, b, x, nullptr, history, looser);
  }

  std::size_t bytes() const { return system_.bytes() + solver_.bytes(); }

 private:
  IsphSystem<D, Backend, Row> system_;
  StagedSolver<1, Backend> solver_;
};

}  // namespace treacle
