#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/block.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/row_sum.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Square sparse matrix of D x D blocks in compressed rows; columns ascend within a row (on the device: in any
/// order).
template <int D, class T = double, class Backend = Cpu>
struct BlockCsr {
  Buffer<std::uint64_t, Backend> rowStart;  // rows + 1
  Buffer<std::uint32_t, Backend> column;    // block columns
  Buffer<Block<D, T>, Backend> block;

  std::uint32_t rows() const { return rowStart.empty() ? 0 : static_cast<std::uint32_t>(rowStart.size() - 1); }
  std::size_t bytes() const { return rowStart.bytes() + column.bytes() + block.bytes(); }
};

/// One row of A x.
template <int D, class T>
inline Vec<D, T> rowProduct(const BlockCsr<D, T>& a, std::size_t row, const Vec<D, T>* x) {
  const Block<D, T>* block = a.block.data();
  const std::uint32_t* column = a.column.data();
  RowSum<D, T> sum;
  for (std::uint64_t k = a.rowStart[row], end = a.rowStart[row + 1]; k < end; ++k) sum.add(block[k], x[column[k]]);
  return sum.total();
}

/// y = A x; spans of A.rows() blocks.
template <int D, class T>
void multiply(Context<Cpu>&, const BlockCsr<D, T>& a, std::span<const Vec<D, T>> x, std::span<Vec<D, T>> y);
template <int D, class T>
void multiply(Context<Cuda>&, const BlockCsr<D, T, Cuda>& a, std::span<const Vec<D, T>> x, std::span<Vec<D, T>> y);

/// Diagonal of the extended Jacobi smoother, half the row sums of |A_ij| [K23 eq. (41)]; the inverse is stored,
/// zero for a row without entries.
template <int D, class T, class S>
void extendedJacobiInverse(Context<Cpu>&, const BlockCsr<D, T>& a, std::span<Vec<D, S>> inverse);
template <int D, class T, class S>
void extendedJacobiInverse(Context<Cuda>&, const BlockCsr<D, T, Cuda>& a, std::span<Vec<D, S>> inverse);

}  // namespace treacle
