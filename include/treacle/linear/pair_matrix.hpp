#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Symmetric matrix of pair coefficients c >= 0 on rows that belong to someone else, (A x)_i = diagonal_i x_i -
/// sum_k c_k x_column(k), each row beginning with its near neighbours. The matrix cut to these, with the diagonal
/// less the coefficients that are cut off, smooths as well as the whole one and is less than half as long. A row
/// may hold its own column, with the coefficient zero. A row of zeros is an unknown that stays zero. In the
/// backend's memory.
template <class T>
struct PairMatrix {
  std::uint32_t rows = 0;
  const std::uint64_t* rowStart = nullptr;   // rows + 1
  const std::uint32_t* nearCount = nullptr;  // per row
  const std::uint32_t* column = nullptr;
  const T* coefficient = nullptr;
  const double* diagonal = nullptr;
  const T* inverseNear = nullptr;  // 1 / diagonal of the cut matrix, or 0
};

/// y = A x; per iteration of CG rows (4 + sizeof(T)) bytes per neighbour and 36 per row.
template <class T>
void multiply(Context<Cpu>&, const PairMatrix<T>& a, std::span<const double> x, std::span<double> y);
template <class T>
void multiply(Context<Cuda>&, const PairMatrix<T>& a, std::span<const double> x, std::span<double> y);

/// x = inverseNear r: one Jacobi sweep from zero.
template <class T>
void firstSweep(Context<Cpu>&, const PairMatrix<T>& a, std::span<const double> r, std::span<T> x);
template <class T>
void firstSweep(Context<Cuda>&, const PairMatrix<T>& a, std::span<const double> r, std::span<T> x);

/// res = r - A_near x
template <class T>
void nearResidual(Context<Cpu>&, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res);
template <class T>
void nearResidual(Context<Cuda>&, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res);

/// z = x + inverseNear (r - A_near x): one Jacobi sweep more.
template <class T>
void lastSweep(Context<Cpu>&, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z);
template <class T>
void lastSweep(Context<Cuda>&, const PairMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z);

/// z = r / diagonal, or 0 where that is not positive.
template <class T>
void jacobi(Context<Cpu>&, const PairMatrix<T>& a, std::span<const double> r, std::span<double> z);
template <class T>
void jacobi(Context<Cuda>&, const PairMatrix<T>& a, std::span<const double> r, std::span<double> z);

/// The matrix as others take it, without its zeros; rows of zeros are empty.
template <class T>
void compressed(Context<Cpu>&, const PairMatrix<T>& a, BlockCsr<1>& result);
template <class T>
void compressed(Context<Cuda>&, const PairMatrix<T>& a, BlockCsr<1, double, Cuda>& result);

}  // namespace treacle
