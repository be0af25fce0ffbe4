#include "treacle/core/each.hpp"
#include "treacle/linear/hat_rows.hpp"

#include <algorithm>

namespace treacle {

template <class T, int B, class Store>
void forEachProduct(Context<Cpu>&, const BlockCsrView<B, T>& a, const T* x, const Store& store) {
  const auto* at = reinterpret_cast<const Vec<B, T>*>(x);
  parallelFor(a.rows, parallelGrain, [&](std::size_t row) {
    const Vec<B, T> total = rowProduct(a, row, at);
    for (int c = 0; c < B; ++c) store(row * B + c, total[c]);
  });
}

namespace {

/// sum += weight v_node
template <int B, class T>
void addScaled(Vec<B, T>& sum, double weight, const T* v, std::uint32_t node) {
  for (int c = 0; c < B; ++c) sum[c] += static_cast<T>(weight) * v[std::size_t{node} * B + c];
}

}  // namespace

template <class T, int B, class Backend>
void hatValues(Context<Backend>&, const BlockCsr<B, double, Backend>& a, std::span<Block<B, T>> value,
               std::span<T> inverseDiagonal) {
  parallelFor(a.rows(), parallelGrain, [&](std::size_t i) {
    Vec<B> diagonal{};
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k) {
      const Block<B>& block = a.value[k];
      for (int c = 0; c < B && a.column[k] == i; ++c) diagonal[c] = block(c, c);
      for (int e = 0; e < B * B && !value.empty(); ++e) value[k].a[e] = static_cast<T>(block.a[e]);
    }
    for (int c = 0; c < B; ++c)
      inverseDiagonal[i * B + c] = diagonal[c] > 0 ? static_cast<T>(1 / diagonal[c]) : T(0);
  });
}

template <int D, int B, class T, class Backend>
void hatRestrict(Context<Backend>&, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                 const T* res, const HatVectors<T>& v) {
  const HatNodesView<D> from = fine.view(), to = coarse.view();
  const FirstStep<T> first(v);
  parallelFor(to.count, parallelGrain, [&](std::size_t row) {
    Vec<B, T> sum{};
    forEachFine(from.lattice, to.pointOf(row), [&](const Vec<D, int>& p, double weight) {
      const std::uint32_t i = from.at(p);
      if (i < from.own) addScaled(sum, weight, res, i);
    });
    for (int c = 0; c < B; ++c) {
      const std::size_t k = row * B + c;
      v.b[k] = sum[c];
      if (first.inverseDiagonal) first(k, sum[c]);
    }
  });
}

template <int D, int B, class T, class Backend>
void hatProlong(Context<Backend>&, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                const T* e, const HatVectors<T>& v) {
  const HatNodesView<D> to = fine.view(), from = coarse.view();
  parallelFor(to.count, parallelGrain, [&](std::size_t row) {
    Vec<B, T> sum{};
    forEachCoarse(to.lattice, to.pointOf(row),
                  [&](const Vec<D, int>& p, double weight) { addScaled(sum, weight, e, from.at(p)); });
    for (int c = 0; c < B; ++c) {
      v.z[0][row * B + c] = sum[c];
      v.x[row * B + c] += sum[c];
    }
  });
}

/// Columns instead of rows, the matrix being symmetric: sums then stand side by side in vector registers.
template <class T, class Backend>
void denseMultiply(Context<Backend>&, std::uint32_t rows, const T* matrix, const T* b, T* x) {
  constexpr std::size_t share = 32;
  parallelFor((rows + share - 1) / share, 2, [=](std::size_t s) {
    const std::size_t first = s * share, count = std::min(share, rows - first);
    T sum[share] = {};
    for (std::size_t k = 0; k < rows; ++k) {
      const T* row = matrix + k * rows + first;
      if (count == share)
        for (std::size_t i = 0; i < share; ++i) sum[i] += row[i] * b[k];
      else
        for (std::size_t i = 0; i < count; ++i) sum[i] += row[i] * b[k];
    }
    std::copy_n(sum, count, x + first);
  });
}

TREACLE_HAT_CYCLE(double, Cpu)
TREACLE_HAT_CYCLE(float, Cpu)

}  // namespace treacle
