#include "treacle/linear/diagonal.hpp"

#include "core/launch.hpp"
#include "treacle/core/cuda.hpp"

namespace treacle {

// The products take one thread per component, so that consecutive threads read consecutive numbers.

template <int D, class T>
void applyDiagonal(Context<Cuda>& context, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r,
                   std::span<Vec<D>> z) {
  forEach(context, D * r.size(), [k = inverse.data(), r = r.data(), z = z.data()] __device__(std::size_t e) {
    z[e / D][e % D] = k[e / D][e % D] * r[e / D][e % D];
  });
}

template <int D, class T>
void applyBlockDiagonal(Context<Cuda>& context, std::span<const Block<D, T>> inverse, std::span<const Vec<D>> r,
                        std::span<Vec<D>> z) {
  forEach(context, D * r.size(), [k = inverse.data(), r = r.data(), z = z.data()] __device__(std::size_t e) {
    const std::size_t i = e / D;
    const int row = static_cast<int>(e % D);
    T sum = 0;
    for (int c = 0; c < D; ++c) sum += k[i](row, c) * static_cast<T>(r[i][c]);
    z[i][row] = sum;
  });
}

template <int D, class T>
void jacobiInverse(Context<Cuda>& context, std::span<const Block<D>> diagonal, std::span<Vec<D, T>> inverse) {
  forEach(context, D * diagonal.size(), [a = diagonal.data(), k = inverse.data()] __device__(std::size_t e) {
    const int c = static_cast<int>(e % D);
    k[e / D][c] = static_cast<T>(1 / a[e / D](c, c));
  });
}

template <int D, class T>
void blockInverse(Context<Cuda>& context, std::span<const Block<D>> diagonal, std::span<Block<D, T>> inverses) {
  forEach(context, diagonal.size(), [a = diagonal.data(), k = inverses.data()] __device__(std::size_t i) {
    const Block<D> m = inverse(a[i]);
    for (int e = 0; e < D * D; ++e) k[i].a[e] = static_cast<T>(m.a[e]);
  });
}

#define TREACLE_INSTANTIATE(D, T)                                                                               \
  template void applyDiagonal<D, T>(Context<Cuda>&, std::span<const Vec<D, T>>, std::span<const Vec<D>>,        \
                                    std::span<Vec<D>>);                                                         \
  template void applyBlockDiagonal<D, T>(Context<Cuda>&, std::span<const Block<D, T>>, std::span<const Vec<D>>, \
                                         std::span<Vec<D>>);                                                    \
  template void jacobiInverse<D, T>(Context<Cuda>&, std::span<const Block<D>>, std::span<Vec<D, T>>);           \
  template void blockInverse<D, T>(Context<Cuda>&, std::span<const Block<D>>, std::span<Block<D, T>>);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
