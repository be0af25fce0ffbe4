#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/near_products.hpp"
#include "treacle/precondition/element_bits.hpp"

#include <cstdint>

namespace treacle {

/// What a block of threads of a device's single-precision products with C and C^T reads: it brings what is
/// gathered of all its particles' neighbours, each once, to shared memory, finds them there by rows of 16 bits,
/// and has the elements beside these. Rows are of slices of nearSlice particles, in fours, filled up with elements
/// that are zero.
template <int D, class Word>
struct StagedView {
  static constexpr std::uint32_t torn = 0xffffffff, inner = 0x80000000;

  const std::uint32_t* member;  // `capacity` per block: who is brought
  // Per block; torn: too many, its rows are those of NearProducts; with `inner` on top where none is a ghost, and
  // the block need not wait until those are brought.
  const std::uint32_t* memberCount;
  const std::uint64_t* start;     // per slice, of its rows, in fours
  const std::uint64_t* place;     // four places in shared memory, per particle of a slice
  const Word *column, *row;       // four elements likewise, g B_j d of C and g B_i d, that of C^T but for its sign
  const Gathered<D, float>* own;  // per own fluid particle: sum of its g B_i d, in units
  float unit;                     // of the elements [1/m]
  const std::uint64_t* sliceStart;  // of NearProducts, for torn blocks
  const std::uint32_t* entry;       // likewise
  std::uint32_t ownFluid, fluidCount, activeCount;
};

/// These lists for the particles of a step whose pairs have B, made from the rows of NearProducts.
template <int D>
class StagedLists {
 public:
  /// Threads of a block. So many share the row of a particle: small systems leave lanes idle, and wait for the
  /// longest row.
  static constexpr unsigned threads = 256;
  static constexpr unsigned sharing(std::uint64_t particles) {
    constexpr std::uint64_t atATime = 1u << 17;  // threads that a card runs at a time
    if (D == 3 && particles < atATime / 4) return 8;
    return particles < atATime ? 4 : 1;
  }
  /// Neighbours of a block.
  static constexpr std::uint32_t capacity(unsigned sharing) {
    if (D == 2) return sharing == 1 ? 768 : 384;
    return sharing == 1 ? 1536 : sharing == 4 ? 768 : 512;
  }

  /// `near`: prepared; `reach`: in h_p, up to which neighbours are taken; `wide`: elements have 64 bits.
  void prepare(Context<Cuda>&, const MphPairs<D>& pairs, const NearProducts<D>& near, double reach, bool wide);

  /// f(view), of words as wide as was asked for.
  template <class F>
  void withView(const MphPairs<D>& pairs, const NearProducts<D>& near, F&& f) const {
    wide_ ? f(view<std::uint64_t>(pairs, near)) : f(view<std::uint32_t>(pairs, near));
  }
  unsigned sharing() const { return sharing_; }
  std::size_t bytes() const {
    return member_.bytes() + memberCount_.bytes() + start_.bytes() + place_.bytes() + column_.bytes() +
           row_.bytes() + own_.bytes();
  }

 private:
  template <class Word>
  StagedView<D, Word> view(const MphPairs<D>& pairs, const NearProducts<D>& near) const {
    return {member_.data(),
            memberCount_.data(),
            start_.data(),
            place_.data(),
            reinterpret_cast<const Word*>(column_.data()),
            reinterpret_cast<const Word*>(row_.data()),
            own_.data(),
            static_cast<float>(unit_),
            near.sliceStart().data(),
            near.entries().data(),
            pairs.ownFluid(),
            pairs.fluidCount,
            pairs.activeCount};
  }
  template <class Word>
  void makeRows(Context<Cuda>&, const MphPairs<D>& pairs, const NearProducts<D>& near, double reach);

  unsigned sharing_ = 1;
  bool wide_ = false;
  double unit_ = 0;  // of the elements [1/m]
  Buffer<std::uint32_t, Cuda> member_, memberCount_;
  Buffer<std::uint64_t, Cuda> start_, place_;
  Buffer<std::uint32_t, Cuda> column_, row_;  // words, or halves of wide ones
  Buffer<Gathered<D, float>, Cuda> own_;
};

}  // namespace treacle
