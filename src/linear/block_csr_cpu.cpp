#include "treacle/linear/block_csr.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D, class T>
void multiply(Context<Cpu>&, const BlockCsr<D, T>& a, std::span<const Vec<D, T>> x, std::span<Vec<D, T>> y) {
  parallelFor(a.rows(), parallelGrain,
              [=, view = viewOf(a)](std::size_t i) { y[i] = rowProduct(view, i, x.data()); });
}

template <int D, class T, class S>
void extendedJacobiInverse(Context<Cpu>&, const BlockCsr<D, T>& a, std::span<Vec<D, S>> inverse) {
  const std::uint32_t rows = a.rows();
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    Vec<D, T> sum{};
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k)
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) sum[r] += std::abs(a.value[k](r, c));
    for (int r = 0; r < D; ++r) inverse[i][r] = sum[r] == 0 ? S(0) : static_cast<S>(2 / sum[r]);
  });
}

#define TREACLE_INSTANTIATE(D, T)                                                                \
  template void multiply<D, T>(Context<Cpu>&, const BlockCsr<D, T>&, std::span<const Vec<D, T>>, \
                               std::span<Vec<D, T>>);                                            \
  template void extendedJacobiInverse<D, T, T>(Context<Cpu>&, const BlockCsr<D, T>&, std::span<Vec<D, T>>);
TREACLE_INSTANTIATE(1, double)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(1, float)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE
template void extendedJacobiInverse<1, double, float>(Context<Cpu>&, const BlockCsr<1>&, std::span<Vec<1, float>>);
template void extendedJacobiInverse<2, double, float>(Context<Cpu>&, const BlockCsr<2>&, std::span<Vec<2, float>>);
template void extendedJacobiInverse<3, double, float>(Context<Cpu>&, const BlockCsr<3>&, std::span<Vec<3, float>>);

}  // namespace treacle
