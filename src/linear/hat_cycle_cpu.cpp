#include "treacle/linear/hat_cycle.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>

namespace treacle {
namespace {

/// store(k, number k of A x) for all numbers
template <class T, int B, class Store>
void rowSums(const BlockCsrView<B, T>& a, const T* x, Store&& store) {
  const auto* at = reinterpret_cast<const Vec<B, T>*>(x);
  parallelFor(a.rows, parallelGrain, [&](std::size_t row) {
    const Vec<B, T> total = rowProduct(a, row, at);
    for (int c = 0; c < B; ++c) store(row * B + c, total[c]);
  });
}

/// sum += weight v_node
template <int B, class T>
void addScaled(Vec<B, T>& sum, double weight, const T* v, std::uint32_t node) {
  for (int c = 0; c < B; ++c) sum[c] += static_cast<T>(weight) * v[std::size_t{node} * B + c];
}

}  // namespace

template <class T, int B>
void hatValues(Context<Cpu>&, const BlockCsr<B>& a, std::span<Block<B, T>> value, std::span<T> inverseDiagonal) {
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

template <class T, int B>
void hatMultiply(Context<Cpu>&, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y) {
  rowSums(a, x.data(), [&](std::size_t k, T sum) { y[k] = sum; });
}

template <class T>
void hatFirstStep(Context<Cpu>&, std::size_t unknowns, const HatVectors<T>& v) {
  const T gain = ChebyshevStep<T>::at(1).gain / hatLambdaMax;
  parallelFor(unknowns, parallelGrain,
              [&](std::size_t i) { v.x[i] = v.z[0][i] = gain * v.inverseDiagonal[i] * v.b[i]; });
}

template <class T, int B>
void hatStep(Context<Cpu>&, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last) {
  const T* z = v.z[last];
  T* next = v.z[1 - last];
  const T gain = step.gain / hatLambdaMax;
  rowSums(a, z, [&](std::size_t k, T sum) {
    v.res[k] = from[k] - sum;
    next[k] = step.previous * z[k] + gain * v.inverseDiagonal[k] * v.res[k];
    v.x[k] += next[k];
  });
}

template <class T, int B>
void hatResidual(Context<Cpu>&, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from, int last) {
  rowSums(a, v.z[last], [&](std::size_t k, T sum) { v.res[k] = from[k] - sum; });
}

template <int D, int B, class T>
void hatRestrict(Context<Cpu>&, const HatNodes<D>& fine, const HatNodes<D>& coarse, const T* res,
                 const HatVectors<T>& v) {
  const HatNodesView<D> from = fine.view(), to = coarse.view();
  const T gain = ChebyshevStep<T>::at(1).gain / hatLambdaMax;
  parallelFor(to.count, parallelGrain, [&](std::size_t row) {
    Vec<B, T> sum{};
    forEachFine(from.lattice, to.pointOf(row), [&](const Vec<D, int>& p, double weight) {
      const std::uint32_t i = from.at(p);
      if (i < from.own) addScaled(sum, weight, res, i);
    });
    for (int c = 0; c < B; ++c) {
      const std::size_t k = row * B + c;
      v.b[k] = sum[c];
      if (v.inverseDiagonal) v.x[k] = v.z[0][k] = gain * v.inverseDiagonal[k] * sum[c];
    }
  });
}

template <int D, int B, class T>
void hatProlong(Context<Cpu>&, const HatNodes<D>& fine, const HatNodes<D>& coarse, const T* e,
                const HatVectors<T>& v) {
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
template <class T>
void denseMultiply(Context<Cpu>&, std::uint32_t rows, const T* matrix, const T* b, T* x) {
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

#define TREACLE_INSTANTIATE(T)                                                     \
  template void hatFirstStep<T>(Context<Cpu>&, std::size_t, const HatVectors<T>&); \
  template void denseMultiply<T>(Context<Cpu>&, std::uint32_t, const T*, const T*, T*);
#define TREACLE_INSTANTIATE_PRODUCTS(T, B)                                                                      \
  template void hatValues<T, B>(Context<Cpu>&, const BlockCsr<B>&, std::span<Block<B, T>>, std::span<T>);       \
  template void hatMultiply<T, B>(Context<Cpu>&, const BlockCsrView<B, T>&, std::span<const T>, std::span<T>);  \
  template void hatStep<T, B>(Context<Cpu>&, const BlockCsrView<B, T>&, ChebyshevStep<T>, const HatVectors<T>&, \
                              const T*, int);                                                                   \
  template void hatResidual<T, B>(Context<Cpu>&, const BlockCsrView<B, T>&, const HatVectors<T>&, const T*, int);
#define TREACLE_INSTANTIATE_TRANSFERS(D, B, T)                                                        \
  template void hatRestrict<D, B, T>(Context<Cpu>&, const HatNodes<D>&, const HatNodes<D>&, const T*, \
                                     const HatVectors<T>&);                                           \
  template void hatProlong<D, B, T>(Context<Cpu>&, const HatNodes<D>&, const HatNodes<D>&, const T*,  \
                                    const HatVectors<T>&);
#define TREACLE_INSTANTIATE_ALL(T)       \
  TREACLE_INSTANTIATE(T)                 \
  TREACLE_INSTANTIATE_PRODUCTS(T, 1)     \
  TREACLE_INSTANTIATE_PRODUCTS(T, 2)     \
  TREACLE_INSTANTIATE_PRODUCTS(T, 3)     \
  TREACLE_INSTANTIATE_TRANSFERS(2, 1, T) \
  TREACLE_INSTANTIATE_TRANSFERS(2, 2, T) \
  TREACLE_INSTANTIATE_TRANSFERS(3, 1, T) \
  TREACLE_INSTANTIATE_TRANSFERS(3, 3, T)
TREACLE_INSTANTIATE_ALL(double)
TREACLE_INSTANTIATE_ALL(float)
#undef TREACLE_INSTANTIATE
#undef TREACLE_INSTANTIATE_PRODUCTS
#undef TREACLE_INSTANTIATE_TRANSFERS
#undef TREACLE_INSTANTIATE_ALL

}  // namespace treacle
