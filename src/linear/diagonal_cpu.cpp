#include "treacle/linear/diagonal.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D, class T>
void applyDiagonal(Context<Cpu>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r,
                   std::span<Vec<D>> z) {
  parallelFor(r.size(), reductionChunk, [&](std::size_t i) {
    for (int k = 0; k < D; ++k) z[i][k] = inverse[i][k] * r[i][k];
  });
}

template <int D, class T>
void applyBlockDiagonal(Context<Cpu>&, std::span<const Block<D, T>> inverse, std::span<const Vec<D>> r,
                        std::span<Vec<D>> z) {
  parallelFor(r.size(), reductionChunk, [&](std::size_t i) {
    Vec<D, T> ri{};
    for (int k = 0; k < D; ++k) ri[k] = static_cast<T>(r[i][k]);
    const Vec<D, T> zi = inverse[i] * ri;
    for (int k = 0; k < D; ++k) z[i][k] = zi[k];
  });
}

template <int D, class T>
void jacobiInverse(Context<Cpu>&, std::span<const Block<D>> diagonal, std::span<Vec<D, T>> inverse) {
  parallelFor(diagonal.size(), parallelGrain, [&](std::size_t i) {
    for (int k = 0; k < D; ++k) inverse[i][k] = static_cast<T>(1 / diagonal[i](k, k));
  });
}

template <int D, class T>
void blockInverse(Context<Cpu>&, std::span<const Block<D>> diagonal, std::span<Block<D, T>> inverses) {
  parallelFor(diagonal.size(), parallelGrain, [&](std::size_t i) {
    const Block<D> m = inverse(diagonal[i]);
    for (int k = 0; k < D * D; ++k) inverses[i].a[k] = static_cast<T>(m.a[k]);
  });
}

#define TREACLE_INSTANTIATE(D, T)                                                                              \
  template void applyDiagonal<D, T>(Context<Cpu>&, std::span<const Vec<D, T>>, std::span<const Vec<D>>,        \
                                    std::span<Vec<D>>);                                                        \
  template void applyBlockDiagonal<D, T>(Context<Cpu>&, std::span<const Block<D, T>>, std::span<const Vec<D>>, \
                                         std::span<Vec<D>>);                                                   \
  template void jacobiInverse<D, T>(Context<Cpu>&, std::span<const Block<D>>, std::span<Vec<D, T>>);           \
  template void blockInverse<D, T>(Context<Cpu>&, std::span<const Block<D>>, std::span<Block<D, T>>);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
