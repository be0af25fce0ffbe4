#include "treacle/linear/bucket_cycle.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace treacle {
namespace {

template <int D, class T>
Vec<D, T> scaled(const Vec<D, T>& diagonal, const Vec<D, T>& v) {
  Vec<D, T> r;
  for (int k = 0; k < D; ++k) r[k] = diagonal[k] * v[k];
  return r;
}

}  // namespace

template <int D, class T, class Backend>
void coarsen(Context<Backend>& context, const BlockCsr<D, T, Backend>& fine,
             std::span<const std::uint32_t> members, BlockCsr<D, T, Backend>& coarse) {
  const auto rows = static_cast<std::uint32_t>(members.size() - 1);
  std::vector<std::uint32_t> parent(fine.rows());
  findParents(context, members, parent);
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
  coarse.value.resize(coarse.rowStart[rows]);
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    const auto& list = columns[i];
    const std::uint64_t start = coarse.rowStart[i];
    std::copy(list.begin(), list.end(), coarse.column.begin() + start);
    std::fill_n(coarse.value.begin() + start, list.size(), Block<D, T>{});
    const auto [begin, end] = entriesOf(i);
    for (std::uint64_t k = begin; k < end; ++k) {
      const auto place = std::lower_bound(list.begin(), list.end(), parent[fine.column[k]]) - list.begin();
      coarse.value[start + place] += fine.value[k];
    }
  });
}

template <int D, class T, class Backend>
void bucketRestrict(Context<Backend>&, const BucketLevel<D, T>& level, std::span<const Vec<D, T>> inverse,
                    std::span<const Vec<D>> r, const BucketVectors<D, T>& v) {
  parallelFor(level.a.rows, parallelGrain, [&](std::size_t p) {
    Vec<D> sum{};
    for (std::uint32_t i = level.members[p]; i < level.members[p + 1]; ++i)
      for (int c = 0; c < D; ++c) sum[c] += inverse[i][c] == 0 ? 0 : r[i][c];
    for (int c = 0; c < D; ++c) v.b[p][c] = static_cast<T>(sum[c]);
    v.x[p] = scaled(level.inverseDiagonal[p], v.b[p]);
  });
}

template <int D, class T, class Backend>
void bucketUnits(Context<Backend>&, const BucketLevel<D, T>& level, std::uint32_t first,
                 const BucketVectors<D, T>& v) {
  const std::uint32_t rows = level.a.rows;
  std::fill_n(v.b, std::size_t{rows} * v.columns, Vec<D, T>{});
  std::fill_n(v.x, std::size_t{rows} * v.columns, Vec<D, T>{});
  for (std::uint32_t column = 0; column < v.columns; ++column) {
    const std::uint32_t row = (first + column) / D, c = (first + column) % D;
    v.b[column * rows + row][c] = 1;
    v.x[column * rows + row][c] = level.inverseDiagonal[row][c];
  }
}

template <int D, class T, class Backend>
void bucketSweep(Context<Backend>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                 const BucketCorrection<D, T>* correction) {
  const std::size_t rows = level.a.rows;
  for (std::size_t column = 0; column < v.columns; ++column) {
    const Vec<D, T>* b = v.b + column * rows;
    Vec<D, T>*x = v.x + column * rows, *next = v.next + column * rows;
    if (correction) {
      const Vec<D, T>* e = correction->e + column * correction->level.a.rows;
      for (std::size_t i = 0; i < rows; ++i) x[i] += e[correction->level.parent[i]];
    }
    parallelFor(rows, parallelGrain, [&](std::size_t i) {
      const Vec<D, T> r = b[i] - rowProduct(level.a, i, x);
      for (int c = 0; c < D; ++c) next[i][c] = x[i][c] + level.inverseDiagonal[i][c] * r[c];
    });
  }
}

template <int D, class T, class Backend>
void bucketRestrictResidual(Context<Backend>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                            const BucketLevel<D, T>& coarse, const BucketVectors<D, T>& coarseV) {
  const std::size_t rows = level.a.rows, coarseRows = coarse.a.rows;
  for (std::size_t column = 0; column < v.columns; ++column) {
    const Vec<D, T>*b = v.b + column * rows, *x = v.x + column * rows;
    Vec<D, T>*coarseB = coarseV.b + column * coarseRows, *coarseX = coarseV.x + column * coarseRows;
    parallelFor(coarseRows, parallelGrain >> D, [&](std::size_t p) {
      Vec<D, T> sum{};
      for (std::uint32_t i = coarse.members[p]; i < coarse.members[p + 1]; ++i)
        sum += b[i] - rowProduct(level.a, i, x);
      coarseB[p] = sum;
      coarseX[p] = scaled(coarse.inverseDiagonal[p], sum);
    });
  }
}

template <class T, class Backend>
void symmetrise(Context<Backend>&, std::uint32_t n, T* matrix) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      matrix[i * n + j] = matrix[j * n + i] = (matrix[i * n + j] + matrix[j * n + i]) / 2;
}

#define TREACLE_INSTANTIATE(T)                                                                                  \
  TREACLE_BUCKET_CYCLE(1, T, Cpu)                                                                               \
  TREACLE_BUCKET_CYCLE(2, T, Cpu)                                                                               \
  TREACLE_BUCKET_CYCLE(3, T, Cpu)                                                                               \
  template void coarsen(Context<Cpu>&, const BlockCsr<1, T>&, std::span<const std::uint32_t>, BlockCsr<1, T>&); \
  template void coarsen(Context<Cpu>&, const BlockCsr<2, T>&, std::span<const std::uint32_t>, BlockCsr<2, T>&); \
  template void coarsen(Context<Cpu>&, const BlockCsr<3, T>&, std::span<const std::uint32_t>, BlockCsr<3, T>&); \
  template void symmetrise(Context<Cpu>&, std::uint32_t, T*);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
