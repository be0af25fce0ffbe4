#include "treacle/linear/block_csr.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D, class T, class Backend>
void multiply(Context<Backend>&, const BlockCsr<D, T, Backend>& a, std::span<const Vec<D, T>> x,
              std::span<Vec<D, T>> y) {
  parallelFor(a.rows(), parallelGrain,
              [=, view = viewOf(a)](std::size_t i) { y[i] = rowProduct(view, i, x.data()); });
}

template <int D, class T, class S, class Backend>
void extendedJacobiInverse(Context<Backend>&, const BlockCsr<D, T, Backend>& a, std::span<Vec<D, S>> inverse) {
  const std::uint32_t rows = a.rows();
  parallelFor(rows, parallelGrain, [&](std::size_t i) {
    Vec<D, T> sum{};
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k)
      for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c) sum[r] += std::abs(a.value[k](r, c));
    for (int r = 0; r < D; ++r) inverse[i][r] = sum[r] == 0 ? S(0) : static_cast<S>(2 / sum[r]);
  });
}

TREACLE_BLOCK_CSR(1, Cpu)
TREACLE_BLOCK_CSR(2, Cpu)
TREACLE_BLOCK_CSR(3, Cpu)

}  // namespace treacle
