#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/linear/block_csr.hpp"
#include "treacle/search/column_blocks.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// How an entry is packed: the place of its column in the row's block (ColumnBlocksView) in the low bits, above it
/// the coefficient in parts of a unit.
struct PackedEntry {
  static constexpr std::uint32_t placeBits = ColumnBlocksView::columnBits, wholeBits = 8;
  static constexpr std::uint32_t parts = 1u << (32 - placeBits - wholeBits);  // of a unit

  TREACLE_HD static std::uint32_t word(std::uint32_t place, double c, double unit) {
    return static_cast<std::uint32_t>(c / unit * parts + 0.5) << placeBits | place;
  }
  TREACLE_HD static std::uint32_t place(std::uint32_t word) { return word & (ColumnBlocksView::columns - 1); }
  /// The coefficient in parts.
  TREACLE_HD static std::uint32_t value(std::uint32_t word) { return word >> placeBits; }
  /// The coefficient in units, rounded to whole ones.
  TREACLE_HD static std::uint32_t whole(std::uint32_t word) {
    return (word + (1u << (31 - wholeBits))) >> (32 - wholeBits);
  }
};

/// Entries of a packed matrix. They stand in fours, which are fetched at once: each section of a row begins with a
/// new one, and ends with zeros.
struct PackedEntriesView {
  std::uint32_t* word = nullptr;        // null: not packed
  const std::uint32_t* four = nullptr;  // 2 rows + 1: the first one of each section
  ColumnBlocksView blocks;

  /// Place of the first entry of a section.
  TREACLE_HD std::uint64_t begin(std::uint64_t section) const { return std::uint64_t{4} * four[section]; }
};

template <class Backend>
struct PackedEntries {
  /// Smaller matrices stay in the cache: what their products take is the time until they begin.
  static constexpr std::uint32_t fewest = 30'000;  // rows

  Buffer<std::uint32_t, Backend> word, four;
  ColumnBlocks<Backend> blocks;

  PackedEntriesView view() { return {word.data(), four.data(), blocks.view()}; }
  std::size_t bytes() const { return word.bytes() + four.bytes() + blocks.bytes(); }
};

/// Symmetric matrix of pair coefficients 0 <= c <= 255 unit on rows that belong to someone else, (A x)_i =
/// diagonal_i x_i - sum_k c_k x_column(k); of several processes each has the rows of its own particles. The
/// entries of all rows' near neighbours come first, then those of the far ones, as in NeighbourRows. A row may
/// hold its own column, with the coefficient zero; a row of zeros is an unknown that stays zero. In the backend's
/// memory.
///
/// Smoothers take the matrix cut to near neighbours, with coefficients rounded to whole units, and the diagonal
/// that belongs to them: it smooths as well as the whole one with a fraction of its bytes.
///
/// On a device large matrices in single precision are packed: 21 bits of a coefficient and the place of its column
/// in four bytes, PackedEntry. Where a block of rows has no places, products take the column from `column`.
template <class T>
struct IsphMatrix {
  std::uint32_t rows = 0;
  const std::uint64_t* start = nullptr;   // 2 rows + 1
  const std::uint32_t* column = nullptr;  // of every entry
  const T* coefficient = nullptr;         // likewise; null where packed
  PackedEntriesView packed;
  double unit = 1;
  const double* diagonal = nullptr;
  const T* inverseNear = nullptr;  // 1 / diagonal of the smoothers' matrix, or 0

  /// Of entry k, which belongs to a section.
  TREACLE_HD double coefficientAt(std::uint64_t section, std::uint64_t k) const {
    if (!packed.word) return static_cast<double>(coefficient[k]);
    return unit / PackedEntry::parts * PackedEntry::value(packed.word[packed.begin(section) + k - start[section]]);
  }
};

/// In all products x has a value for every column, those of ghosts included (fillGhosts), and other vectors one
/// for every row.

/// y = A x; it reads 4 + sizeof(T) bytes per entry, 4 where packed, and 40 per row; the two that follow the same
/// per near entry.
template <class T, class Backend>
void multiply(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y);

/// The same for x whose numbers are single precision, which a device then brings together as such.
template <class T, class Backend>
void multiplySingle(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y);

/// x = inverseNear r: one Jacobi sweep from zero.
template <class T, class Backend>
void firstSweep(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<T> x);

/// res = r - A_near x
template <class T, class Backend>
void nearResidual(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res);

/// z = x + inverseNear (r - A_near x): one Jacobi sweep more.
template <class T, class Backend>
void lastSweep(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z);

/// z = r / diagonal, or 0 where that is not positive.
template <class T, class Backend>
void jacobi(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<double> z);

/// The matrix as others take it, without its zeros; rows of zeros are empty, and those of ghosts, up to `rows`.
template <class T, class Backend>
void compressed(Context<Backend>&, const IsphMatrix<T>& a, std::uint32_t rows,
                BlockCsr<1, double, Backend>& result);

}  // namespace treacle
