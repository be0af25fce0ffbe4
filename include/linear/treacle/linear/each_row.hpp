#pragma once

#include "treacle/core/device_link.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/linear/bucket_cycle.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/linear/joined_rows.hpp"

#include <algorithm>
#include <type_traits>

namespace treacle {

// What is done with each row of a matrix, or each component of a vector's blocks, for the sources of both
// backends, which instantiate it. A thread of a device has one; there are no atomics. Each backend has, beside
// forEach and startRows,
//
//   forEachComponent<D>(context, n, body): body(i, c) for the components c of n vectors

template <int D, class T, class Backend>
void applyDiagonal(Context<Backend>& context, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r,
                   std::span<Vec<D>> z) {
  forEachComponent<D>(context, r.size(),
                      [=] TREACLE_HD(std::size_t i, int c) { z[i][c] = inverse[i][c] * r[i][c]; });
}

template <int D, class T, class Backend>
void jacobiInverse(Context<Backend>& context, std::span<const Block<D>> diagonal, std::span<Vec<D, T>> inverse) {
  forEachComponent<D>(context, diagonal.size(), [=] TREACLE_HD(std::size_t i, int c) {
    inverse[i][c] = static_cast<T>(1 / diagonal[i](c, c));
  });
}

template <int D, class T, class Backend>
void blockInverse(Context<Backend>& context, std::span<const Block<D>> diagonal, std::span<Block<D, T>> inverses) {
  forEach(context, diagonal.size(), [=] TREACLE_HD(std::size_t i) {
    const Block<D> m = inverse(diagonal[i]);
    for (int e = 0; e < D * D; ++e) inverses[i].a[e] = static_cast<T>(m.a[e]);
  });
}

template <class Backend>
void findParents(Context<Backend>& context, std::span<const std::uint32_t> members,
                 std::span<std::uint32_t> parent) {
  forEach(context, members.size() - 1, [=] TREACLE_HD(std::size_t row) {
    for (std::uint32_t i = members[row]; i < members[row + 1]; ++i) parent[i] = static_cast<std::uint32_t>(row);
  });
}

template <int D, class T, class Backend>
void convert(Context<Backend>& context, const BlockCsr<D, double, Backend>& from, BlockCsr<D, T, Backend>& to) {
  to.rowStart.resize(context, from.rowStart.size());
  to.column.resize(context, from.column.size());
  to.value.resize(context, from.value.size());
  copyValues(context, from.rowStart.span(), to.rowStart.data());
  copyValues(context, from.column.span(), to.column.data());
  const auto* source = reinterpret_cast<const double*>(from.value.data());
  auto* target = reinterpret_cast<T*>(to.value.data());
  forEach(context, from.value.size() * D * D,
          [=] TREACLE_HD(std::size_t k) { target[k] = static_cast<T>(source[k]); });
}

template <int D, class T, class Backend>
void bucketProlong(Context<Backend>& context, const BucketLevel<D, T>& level, const Vec<D, T>* x,
                   std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z) {
  const std::uint32_t* const bucketOf = level.parent;
  forEachComponent<D>(context, r.size(), [=] TREACLE_HD(std::size_t i, int c) {
    z[i][c] = inverse[i][c] == 0 ? 0 : inverse[i][c] * r[i][c] + x[bucketOf[i]][c];
  });
}

/// Columns stand in the order of the part that the row is own in; on the CPU they ascend.
template <int D, class Backend>
void joinRows(Context<Backend>& context, const BlockCsr<D, double, Backend>& part, const JoinedRows& place,
              BlockCsr<D, double, Backend>& whole) {
  const BlockCsrView<D> from = viewOf(part);
  const std::uint32_t* const number = place.number.data();
  Buffer<std::uint32_t, Backend> counts(context, place.rows);
  std::uint32_t* const entries = counts.data();
  clearValues(context, counts.span());
  forEach(context, place.own, [=] TREACLE_HD(std::size_t r) {
    entries[number[r]] = static_cast<std::uint32_t>(from.rowStart[r + 1] - from.rowStart[r]);
  });
  sumOverSharing(context, counts.span());
  whole.rowStart.resize(context, std::size_t{place.rows} + 1);
  std::uint64_t* const start = whole.rowStart.data();
  forEach(context, place.rows, [=] TREACLE_HD(std::size_t r) { start[r] = entries[r]; });
  const std::uint64_t count = startRows(context, whole.rowStart);

  whole.column.resize(context, count);
  std::uint32_t* const column = whole.column.data();
  clearValues(context, whole.column.span());
  forEach(context, place.own, [=] TREACLE_HD(std::size_t r) {
    std::uint32_t *const row = column + start[number[r]], *to = row;
    for (std::uint64_t k = from.rowStart[r]; k < from.rowStart[r + 1]; ++k) *to++ = number[from.column[k]];
    if constexpr (std::is_same_v<Backend, Cpu>) std::sort(row, to);
  });
  sumOverSharing(context, whole.column.span());

  whole.value.resize(context, count);
  Block<D>* const value = whole.value.data();
  clearValues(context, whole.value.span());
  forEach(context, from.rows, [=] TREACLE_HD(std::size_t r) {
    for (std::uint64_t k = from.rowStart[r]; k < from.rowStart[r + 1]; ++k) {
      std::uint64_t at = start[number[r]];
      while (column[at] != number[from.column[k]]) ++at;
      value[at] = from.value[k];
    }
  });
  sumOverSharing(context, std::span(reinterpret_cast<double*>(whole.value.data()), count * D * D));
}

#define TREACLE_EACH_ROW(Backend)                                                                         \
  template void findParents(Context<Backend>&, std::span<const std::uint32_t>, std::span<std::uint32_t>); \
  TREACLE_EACH_ROW_OF(1, Backend)                                                                         \
  TREACLE_EACH_ROW_OF(2, Backend)                                                                         \
  TREACLE_EACH_ROW_OF(3, Backend)                                                                         \
  TREACLE_EACH_DIAGONAL(2, double, Backend)                                                               \
  TREACLE_EACH_DIAGONAL(3, double, Backend)                                                               \
  TREACLE_EACH_DIAGONAL(2, float, Backend)                                                                \
  TREACLE_EACH_DIAGONAL(3, float, Backend)
#define TREACLE_EACH_ROW_OF(D, Backend)                                                             \
  template void joinRows(Context<Backend>&, const BlockCsr<D, double, Backend>&, const JoinedRows&, \
                         BlockCsr<D, double, Backend>&);                                            \
  TREACLE_EACH_COMPONENT(D, double, Backend)                                                        \
  TREACLE_EACH_COMPONENT(D, float, Backend)
#define TREACLE_EACH_COMPONENT(D, T, Backend)                                                              \
  template void convert(Context<Backend>&, const BlockCsr<D, double, Backend>&, BlockCsr<D, T, Backend>&); \
  template void bucketProlong(Context<Backend>&, const BucketLevel<D, T>&, const Vec<D, T>*,               \
                              std::span<const Vec<D, T>>, std::span<const Vec<D>>, std::span<Vec<D>>);
#define TREACLE_EACH_DIAGONAL(D, T, Backend)                                                                 \
  template void applyDiagonal(Context<Backend>&, std::span<const Vec<D, T>>, std::span<const Vec<D>>,        \
                              std::span<Vec<D>>);                                                            \
  template void applyBlockDiagonal(Context<Backend>&, std::span<const Block<D, T>>, std::span<const Vec<D>>, \
                                   std::span<Vec<D>>);                                                       \
  template void jacobiInverse(Context<Backend>&, std::span<const Block<D>>, std::span<Vec<D, T>>);           \
  template void blockInverse(Context<Backend>&, std::span<const Block<D>>, std::span<Block<D, T>>);

}  // namespace treacle
