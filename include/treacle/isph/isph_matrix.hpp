#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// How an entry is packed.
struct PackedEntry {
  static constexpr std::uint32_t columnBits = 24, maxRows = 1u << 23;

  /// Whole units of a coefficient.
  TREACLE_HD static std::uint32_t whole(double c, double unit) {
    return static_cast<std::uint32_t>(c / unit + 0.5);
  }
  TREACLE_HD static std::uint32_t word(std::uint32_t column, double c, double unit) {
    return column << 8 | whole(c, unit);
  }
  /// The rest lies between -1/2 and 1/2 units.
  TREACLE_HD static std::uint16_t low(double c, double unit) {
    const double rest = (c / unit - whole(c, unit)) * 65536 + 32768.5;
    return static_cast<std::uint16_t>(rest < 65535 ? rest : 65535);
  }
  /// The coefficient in units.
  TREACLE_HD static double value(std::uint32_t word, std::uint16_t low) {
    const int fixed = static_cast<int>((word & 255) << 16) + static_cast<int>(low) - 32768;
    return fixed * (1.0 / 65536);
  }
  TREACLE_HD static std::uint32_t column(std::uint32_t word, std::uint32_t row) {
    const auto away = static_cast<std::int32_t>(((word >> 8) - row) << 8) >> 8;
    return row + static_cast<std::uint32_t>(away);
  }
};

/// Symmetric matrix of pair coefficients 0 <= c <= 255 unit on rows that belong to someone else, (A x)_i =
/// diagonal_i x_i - sum_k c_k x_column(k). The entries of all rows' near neighbours come first, then those of the
/// far ones, as in NeighbourRows. A row may hold its own column, with the coefficient zero; a row of zeros is an
/// unknown that stays zero. In the backend's memory.
///
/// Smoothers take the matrix cut to near neighbours, with coefficients rounded to whole units, and the diagonal
/// that belongs to them: it smooths as well as the whole one with a fraction of its bytes.
///
/// On a device in single precision the entries are packed: `word` has the low 24 bits of the column and the whole
/// units of c, `low` the rest of c, 24 bits in all. That is enough where no two neighbours are 2^23 rows apart;
/// larger matrices have `coefficient`.
template <class T>
struct IsphMatrix {
  std::uint32_t rows = 0;
  const std::uint64_t* start = nullptr;   // 2 rows + 1
  const std::uint32_t* column = nullptr;  // of every entry
  const T* coefficient = nullptr;         // likewise; null where packed
  const std::uint32_t* word = nullptr;
  const std::uint16_t* low = nullptr;
  double unit = 1;
  const double* diagonal = nullptr;
  const T* inverseNear = nullptr;  // 1 / diagonal of the smoothers' matrix, or 0

  TREACLE_HD double coefficientAt(std::uint64_t k) const {
    return word ? unit * PackedEntry::value(word[k], low[k]) : static_cast<double>(coefficient[k]);
  }
};

/// y = A x; it reads 4 + sizeof(T) bytes per entry, 6 where packed, and 40 per row; the two that follow 4 +
/// sizeof(T) bytes, 4 where packed, per near entry.
template <class T>
void multiply(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y);
template <class T>
void multiply(Context<Cuda>&, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y);

/// x = inverseNear r: one Jacobi sweep from zero.
template <class T>
void firstSweep(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<T> x);
template <class T>
void firstSweep(Context<Cuda>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<T> x);

/// res = r - A_near x
template <class T>
void nearResidual(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res);
template <class T>
void nearResidual(Context<Cuda>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res);

/// z = x + inverseNear (r - A_near x): one Jacobi sweep more.
template <class T>
void lastSweep(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z);
template <class T>
void lastSweep(Context<Cuda>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z);

/// z = r / diagonal, or 0 where that is not positive.
template <class T>
void jacobi(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<double> z);
template <class T>
void jacobi(Context<Cuda>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<double> z);

/// The matrix as others take it, without its zeros; rows of zeros are empty.
template <class T>
void compressed(Context<Cpu>&, const IsphMatrix<T>& a, BlockCsr<1>& result);
template <class T>
void compressed(Context<Cuda>&, const IsphMatrix<T>& a, BlockCsr<1, double, Cuda>& result);

}  // namespace treacle
