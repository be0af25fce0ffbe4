#pragma once

#include "treacle/core/lanes.hpp"
#include "treacle/precondition/element_bits.hpp"
#include "treacle/precondition/packed_rows.hpp"
#include "treacle/search/cluster_lanes.hpp"

#include <cstdint>
#include <initializer_list>

namespace treacle {

/// Elements of C in 32 bits, eight or sixteen at a time.
template <int D>
struct PackedElement : ElementBits<D, std::uint32_t> {
  using Bits = ElementBits<D, std::uint32_t>;
  using Bits::bits, Bits::lastBits, Bits::largest;
  using Words = LanesOf<std::uint32_t>;
  using WordPair = Simd<std::uint32_t, 2 * laneCount>;
  using IntPair = Simd<std::int32_t, 2 * laneCount>;
  using FloatPair = Simd<float, 2 * laneCount>;

  /// Eight elements `factor` v, which are at most `largest`.
  static Words pack(const VecLanes<D>& v, const Lanes& factor) {
    constexpr double rounder = 6755399441055744.0;  // 1.5 2^52: adding it leaves whole numbers
    Words packed = {};
    for (int k = 0; k < D; ++k) {
      const bool last = k == D - 1;
      const int own = last ? lastBits : bits;
      const Lanes rounded = (v[k] * factor * (1 / Bits::unitOf(k)) + rounder) - rounder;
      packed |=
          convert<Words>(convert<LanesOf<std::int32_t>>(rounded)) << (32 - own) >> (last ? 32 - own : k * bits);
    }
    return packed;
  }

  /// The D components of sixteen elements, times unitOfUnpacked.
  [[gnu::always_inline]] static void unpack(const WordPair& words, FloatPair (&v)[D]) {
    constexpr std::uint32_t mask = ~std::uint32_t{0} << (32 - bits);
    for (int k = 0; k < D; ++k) {
      const WordPair field = k == D - 1 ? words << (32 - lastBits) : words << (k * bits) & mask;
      v[k] = convert<FloatPair>(convert<IntPair>(field));
    }
  }
  static constexpr double unitOfUnpacked = 1u << (32 - bits);
};

/// Pairs of columns ahead that are asked for: a pair is computed in less time than memory takes, even the shared
/// cache.
constexpr int packedPrefetch = 48;

/// Room for the entries of some segments.
inline void allocate(PackedRows& rows, const ClusterListView& list, std::initializer_list<ListSegment> segments) {
  const std::uint32_t clusters = list.clusterCount();
  rows.start.resize(std::size_t{clusters} + 1);
  rows.pairs.resize(clusters);
  rows.start[0] = 0;
  for (std::uint32_t c = 0; c < clusters; ++c) {
    std::uint64_t entries = 0;
    for (ListSegment s : segments) entries += list.segment(c, s).size();
    rows.start[c + 1] = rows.start[c] + (entries + 1) / 2;
  }
  rows.column.resize(2 * rows.start[clusters]);
  rows.word.resize(2 * clusterSize * rows.start[clusters]);
}

/// Writes the rows of one cluster, column by column; columns without an element are left out.
template <int D>
class PackedWriter {
 public:
  using Words = typename PackedElement<D>::Words;

  PackedWriter(PackedRows& rows, std::uint32_t cluster)
      : rows_(rows), cluster_(cluster), next_(2 * rows.start[cluster]) {}
  PackedWriter(const PackedWriter&) = delete;
  ~PackedWriter() {
    if (next_ % 2 == 1) write(rows_.column[next_ - 1], Words{});
    rows_.pairs[cluster_] = static_cast<std::uint32_t>(next_ / 2 - rows_.start[cluster_]);
  }
  void add(std::uint32_t column, const Words& words) {
    if (any_of(words != 0u)) write(column, words);
  }

 private:
  void write(std::uint32_t column, const Words& words) {
    rows_.column[next_] = column;
    store(words, &rows_.word[next_++ * clusterSize]);
  }
  PackedRows& rows_;
  std::uint32_t cluster_;
  std::uint64_t next_;
};

/// Calls f(one column, the other, their elements) for the pairs of columns of a cluster.
template <int D, class F>
[[gnu::always_inline]] inline void forEachPair(const PackedRows& rows, std::uint32_t cluster, F&& f) {
  using Element = PackedElement<D>;
  const std::uint64_t first = rows.start[cluster];
  const std::uint32_t *at = &rows.column[2 * first], *words = &rows.word[2 * clusterSize * first];
  for (std::uint32_t p = 0, n = rows.pairs[cluster]; p < n; ++p, at += 2, words += 2 * clusterSize) {
    __builtin_prefetch(words + packedPrefetch * 2 * clusterSize);
    typename Element::FloatPair element[D];
    Element::unpack(load<typename Element::WordPair>(words), element);
    f(at[0], at[1], element);
  }
}

}  // namespace treacle
