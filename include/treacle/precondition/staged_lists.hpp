#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/near_products.hpp"
#include "treacle/precondition/projection_terms.hpp"

#include <cstdint>

namespace treacle {

/// What a block of threads of a device's single-precision products reads: it brings what is gathered of all its
/// particles' neighbours, each once, to shared memory, and finds them there by rows of 16 bits.
struct StagedView {
  static constexpr std::uint32_t torn = 0xffffffff;

  const std::uint32_t* member;       // `capacity` per block: who is brought
  const std::uint32_t* memberCount;  // per block; torn: too many or too far apart, the rows of NearProducts serve
  const std::uint32_t* quads;        // per slice: length of its rows in fours
  const std::uint64_t* entry;        // four places in shared memory, in bytes, per particle of a slice
  const std::uint64_t* sliceStart;   // of NearProducts, which says where there is room for a slice's rows
  float reach2;                      // squared length of the rows, for the rows of NearProducts

  /// The particle from which a block's places are counted.
  TREACLE_HD static std::uint32_t origin(std::uint32_t block, std::uint32_t particles, std::uint32_t active) {
    const std::uint32_t middle = block * particles + particles / 2;
    return middle < active ? middle : active - 1;
  }
  TREACLE_HD static std::uint64_t start(std::uint64_t rowsBefore, std::uint64_t slice) {
    return (rowsBefore + 3 * slice) / 4;
  }
};

/// These lists for the particles of a step, made from the rows of NearProducts.
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
  /// Neighbours of a block, and the shared memory that they take.
  static constexpr std::uint32_t capacity(unsigned sharing) {
    if (D == 2) return sharing == 1 ? 768 : 384;
    return sharing == 1 ? 1536 : sharing == 4 ? 768 : 512;
  }
  static constexpr std::size_t sharedBytes(unsigned sharing) { return std::size_t{16} * capacity(sharing); }

  /// `near`: prepared; `places`: coarse positions per particle, in whatever is beside them. `reach`: in h_p, up to
  /// which neighbours are taken.
  void prepare(Context<Cuda>&, const MphPairs<D>& pairs, const NearProducts<D>& near, const PlacedScalar* places,
               double reach);

  StagedView view(const NearProducts<D>& near) const {
    return {member_.data(), memberCount_.data(), quads_.data(), entry_.data(), near.sliceStart().data(), reach2_};
  }
  unsigned sharing() const { return sharing_; }
  std::size_t bytes() const { return member_.bytes() + memberCount_.bytes() + quads_.bytes() + entry_.bytes(); }

 private:
  unsigned sharing_ = 1;
  float reach2_ = 0;  // [h_v^2]
  Buffer<std::uint32_t, Cuda> member_, memberCount_, quads_;
  Buffer<std::uint64_t, Cuda> entry_;
};

}  // namespace treacle
