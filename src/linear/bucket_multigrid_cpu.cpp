#include "treacle/linear/bucket_multigrid.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace treacle {
namespace {

template <int D, class T>
void convert(const BlockCsr<D>& from, BlockCsr<D, T>& to) {
  to.rowStart.resize(from.rowStart.size());
  to.column.resize(from.column.size());
  to.block.resize(from.block.size());
  std::copy(from.rowStart.begin(), from.rowStart.end(), to.rowStart.begin());
  std::copy(from.column.begin(), from.column.end(), to.column.begin());
  for (std::size_t k = 0; k < from.block.size(); ++k)
    for (int e = 0; e < D * D; ++e) to.block[k].a[e] = static_cast<T>(from.block[k].a[e]);
}

}  // namespace

template <int D, class T>
void coarsen(Context<Cpu>&, const BlockCsr<D, T>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T>& coarse) {
  const auto rows = static_cast<std::uint32_t>(members.size() - 1);
  std::vector<std::uint32_t> parent(fine.rows());
  for (std::uint32_t i = 0; i < rows; ++i)
    std::fill(parent.begin() + members[i], parent.begin() + members[i + 1], i);
  const auto entriesOf = [&](std::size_t i) {
    return std::pair{fine.rowStart[members[i]], fine.rowStart[members[i + 1]]};
  };

  coarse.rowStart.resize(rows + 1);
  coarse.rowStart[0] = 0;
  std::vector<std::vector<std::uint32_t>> columns(rows);
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    const auto [begin, end] = entriesOf(i);
    auto& list = columns[i];
    for (std::uint64_t k = begin; k < end; ++k) {
      const std::uint32_t column = parent[fine.column[k]];
      const auto place = std::lower_bound(list.begin(), list.end(), column);
      if (place == list.end() || *place != column) list.insert(place, column);
    }
  });
  for (std::uint32_t i = 0; i < rows; ++i) coarse.rowStart[i + 1] = coarse.rowStart[i] + columns[i].size();

  coarse.column.resize(coarse.rowStart[rows]);
  coarse.block.resize(coarse.rowStart[rows]);
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    const auto& list = columns[i];
    const std::uint64_t start = coarse.rowStart[i];
    std::copy(list.begin(), list.end(), coarse.column.begin() + start);
    std::fill_n(coarse.block.begin() + start, list.size(), Block<D, T>{});
    const auto [begin, end] = entriesOf(i);
    for (std::uint64_t k = begin; k < end; ++k) {
      const auto place = std::lower_bound(list.begin(), list.end(), parent[fine.column[k]]) - list.begin();
      coarse.block[start + place] += fine.block[k];
    }
  });
}

template <int D, class T>
void BucketMultigrid<D, T, Cpu>::setup(Context<Cpu>& context, const BlockCsr<D>& finest,
                                       std::vector<std::span<const std::uint32_t>> members,
                                       const CycleSweeps& sweeps) {
  members_ = std::move(members);
  sweeps_ = sweeps;
  levels_.resize(members_.size());
  convert(finest, levels_[0].a);
  for (std::size_t r = 0; r < levels_.size(); ++r) {
    Level& level = levels_[r];
    if (r > 0) coarsen(context, levels_[r - 1].a, members_[r], level.a);
    const std::uint32_t rows = level.a.rows();
    for (Buffer<Vec<D, T>>* v : {&level.inverseDiagonal, &level.b, &level.x, &level.next}) v->resize(rows);
    extendedJacobiInverse<D, T, T>(context, level.a, level.inverseDiagonal);
  }
}

/// x += D^-1 (b - A x)  [K23 eq. (42)]
template <int D, class T>
void BucketMultigrid<D, T, Cpu>::sweep(Level& level) {
  const BlockCsr<D, T>& a = level.a;
  const std::uint32_t rows = a.rows();
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    const Vec<D, T> r = level.b[i] - rowProduct(a, i, level.x.data());
    for (int c = 0; c < D; ++c) level.next[i][c] = level.x[i][c] + level.inverseDiagonal[i][c] * r[c];
  });
  std::swap(level.x, level.next);
}

template <int D, class T>
void BucketMultigrid<D, T, Cpu>::cycle(Context<Cpu>& context, std::size_t r) {
  Level& level = levels_[r];
  const BlockCsr<D, T>& a = level.a;
  const bool coarsest = r + 1 == levels_.size();
  const int sweeps = coarsest ? sweeps_.coarsest : r == 0 ? sweeps_.finest : sweeps_.middle;

  for (std::uint32_t i = 0; i < a.rows(); ++i)  // the first sweep, from zero
    for (int c = 0; c < D; ++c) level.x[i][c] = level.inverseDiagonal[i][c] * level.b[i][c];
  for (int s = 1; s < sweeps; ++s) sweep(level);
  if (coarsest) return;

  Level& coarse = levels_[r + 1];
  const auto members = members_[r + 1];
  const std::uint32_t coarseRows = coarse.a.rows();
  parallelFor(coarseRows, parallelGrain >> D, [&](std::size_t p) {
    Vec<D, T> sum{};
    for (std::uint32_t i = members[p]; i < members[p + 1]; ++i)
      sum += level.b[i] - rowProduct(a, i, level.x.data());
    coarse.b[p] = sum;
  });
  cycle(context, r + 1);
  for (std::uint32_t p = 0; p < coarseRows; ++p)
    for (std::uint32_t i = members[p]; i < members[p + 1]; ++i) level.x[i] += coarse.x[p];

  for (int s = 0; s < sweeps; ++s) sweep(level);
}

/// b = R value(particle, component) on the finest level.
template <int D, class T>
template <class Value>
void BucketMultigrid<D, T, Cpu>::restrict(const Value& value) {
  Level& finest = levels_[0];
  const auto members = members_[0];
  parallelFor(finest.a.rows(), parallelGrain, [&](std::size_t b) {
    Vec<D> sum{};
    for (std::uint32_t i = members[b]; i < members[b + 1]; ++i)
      for (int c = 0; c < D; ++c) sum[c] += value(i, c);
    for (int c = 0; c < D; ++c) finest.b[b][c] = static_cast<T>(sum[c]);
  });
}

template <int D, class T>
void BucketMultigrid<D, T, Cpu>::apply(Context<Cpu>& context, std::span<const Vec<D, T>> inverse,
                                       std::span<const Vec<D>> r, std::span<Vec<D>> z) {
  restrict([&](std::uint32_t i, int c) { return inverse[i][c] == 0 ? 0 : r[i][c]; });
  cycle(context, 0);
  const auto members = members_[0];
  parallelFor(levels_[0].a.rows(), parallelGrain, [&](std::size_t b) {
    for (std::uint32_t i = members[b]; i < members[b + 1]; ++i)
      for (int c = 0; c < D; ++c) z[i][c] = inverse[i][c] == 0 ? 0 : inverse[i][c] * r[i][c] + levels_[0].x[b][c];
  });
}

template <int D, class T>
void BucketMultigrid<D, T, Cpu>::correct(Context<Cpu>& context, std::span<const Gathered<D, T>> r,
                                         std::span<Gathered<D, T>> z, std::span<Gathered<D, T>> x) {
  restrict([&](std::uint32_t i, int c) { return r[i][c]; });
  cycle(context, 0);
  const auto members = members_[0];
  parallelFor(levels_[0].a.rows(), parallelGrain, [&](std::size_t b) {
    for (std::uint32_t i = members[b]; i < members[b + 1]; ++i) {
      z[i] = levels_[0].x[b];
      x[i] += levels_[0].x[b];
    }
  });
}

template <int D, class T>
std::size_t BucketMultigrid<D, T, Cpu>::bytes() const {
  std::size_t sum = 0;
  for (const Level& l : levels_)
    sum += l.a.bytes() + l.inverseDiagonal.bytes() + l.b.bytes() + l.x.bytes() + l.next.bytes();
  return sum;
}

#define TREACLE_INSTANTIATE(D, T)                                                                   \
  template void coarsen<D, T>(Context<Cpu>&, const BlockCsr<D, T>&, std::span<const std::uint32_t>, \
                              BlockCsr<D, T>&);                                                     \
  template class BucketMultigrid<D, T, Cpu>;
TREACLE_INSTANTIATE(1, double)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(1, float)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
