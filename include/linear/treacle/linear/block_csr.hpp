#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/block.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/row_sum.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Rows of a sparse matrix, compressed: row i has value[k] in column[k] for k from rowStart[i] to rowStart[i + 1].
/// Columns ascend within a row (on the device: in any order).
template <class V, class Backend = Cpu>
struct Csr {
  Buffer<std::uint64_t, Backend> rowStart;  // rows + 1
  Buffer<std::uint32_t, Backend> column;
  Buffer<V, Backend> value;

  std::uint32_t rows() const { return rowStart.empty() ? 0 : static_cast<std::uint32_t>(rowStart.size() - 1); }
  std::size_t bytes() const { return rowStart.bytes() + column.bytes() + value.bytes(); }
};

/// Square sparse matrix of D x D blocks; columns count blocks.
template <int D, class T = double, class Backend = Cpu>
using BlockCsr = Csr<Block<D, T>, Backend>;

/// What loops and kernels read of such a matrix; pattern and values may belong to different owners.
template <int D, class T = double>
struct BlockCsrView {
  std::uint32_t rows = 0;
  std::uint64_t entries = 0;  // blocks
  const std::uint64_t* rowStart = nullptr;
  const std::uint32_t* column = nullptr;
  const Block<D, T>* value = nullptr;
};
template <int D, class T, class Backend>
BlockCsrView<D, T> viewOf(const Csr<Block<D, T>, Backend>& a) {
  return {a.rows(), a.value.size(), a.rowStart.data(), a.column.data(), a.value.data()};
}

/// One row of A x.
template <int D, class T>
inline Vec<D, T> rowProduct(const BlockCsrView<D, T>& a, std::size_t row, const Vec<D, T>* x) {
  RowSum<D, T> sum;
  for (std::uint64_t k = a.rowStart[row], end = a.rowStart[row + 1]; k < end; ++k)
    sum.add(a.value[k], x[a.column[k]]);
  return sum.total();
}

/// y = A x; spans of A.rows() blocks.
template <int D, class T, class Backend>
void multiply(Context<Backend>&, const BlockCsr<D, T, Backend>& a, std::span<const Vec<D, T>> x,
              std::span<Vec<D, T>> y);

/// Diagonal of the extended Jacobi smoother, half the row sums of |A_ij| [K23 eq. (41)]; the inverse is stored,
/// zero for a row without entries.
template <int D, class T, class S, class Backend>
void extendedJacobiInverse(Context<Backend>&, const BlockCsr<D, T, Backend>& a, std::span<Vec<D, S>> inverse);

/// For the sources of both backends.
#define TREACLE_BLOCK_CSR(D, Backend)                                                                             \
  template void multiply(Context<Backend>&, const BlockCsr<D, double, Backend>&, std::span<const Vec<D>>,         \
                         std::span<Vec<D>>);                                                                      \
  template void multiply(Context<Backend>&, const BlockCsr<D, float, Backend>&, std::span<const Vec<D, float>>,   \
                         std::span<Vec<D, float>>);                                                               \
  template void extendedJacobiInverse(Context<Backend>&, const BlockCsr<D, double, Backend>&, std::span<Vec<D>>); \
  template void extendedJacobiInverse(Context<Backend>&, const BlockCsr<D, double, Backend>&,                     \
                                      std::span<Vec<D, float>>);                                                  \
  template void extendedJacobiInverse(Context<Backend>&, const BlockCsr<D, float, Backend>&,                      \
                                      std::span<Vec<D, float>>);

}  // namespace treacle
