#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Jacobi sweeps of the V-cycle [K23 sect. 3.2].
struct CycleSweeps {
  int finest = 2;    // before and after the coarse correction, level 0
  int middle = 3;    // likewise, levels between
  int coarsest = 4;  // on the last level
};

/// K = D^-1 + P M^0 R of [K23 eq. (43)]: a diagonal on the particles plus a V-cycle on the buckets, whose
/// operators are Galerkin products by summation [K23 eqs. (35)-(38)] and whose smoother is the extended Jacobi
/// iteration [K23 eq. (42)]. T is the precision of everything inside; the vectors outside are double.
template <int D, class T>
class BucketMultigrid {
 public:
  /// `finest`: A^0 = R A P, one row per level-0 bucket. `members`: per level the first member of each bucket and
  /// the end (BucketLevels::begin); they must outlive the last apply().
  void setup(Context<Cpu>&, const BlockCsr<D>& finest, std::vector<std::span<const std::uint32_t>> members,
             const CycleSweeps& sweeps);

  /// z = diag(inverse) r + P M^0 R r, per particle. `inverse`: D^-1 of the particles.
  void apply(Context<Cpu>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);

  std::size_t levelCount() const { return levels_.size(); }
  const BlockCsr<D, T>& matrix(std::size_t level) const { return levels_[level].a; }
  std::size_t bytes() const;

 private:
  struct Level {
    BlockCsr<D, T> a;
    Buffer<Vec<D, T>> inverseDiagonal;
    Buffer<Vec<D, T>> b, x, next;  // right-hand side, iterate, and where a sweep writes
  };

  void cycle(Context<Cpu>& context, std::size_t level);
  void sweep(Level& level);

  std::vector<Level> levels_;
  std::vector<std::span<const std::uint32_t>> members_;
  CycleSweeps sweeps_;
};

/// Galerkin operator of the next coarser level by summation, A^{r+1} = R A^r P [K23 eq. (38)]. `members`: first
/// fine row of each coarse one, and the end.
template <int D, class T>
void coarsen(Context<Cpu>&, const BlockCsr<D, T>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T>& coarse);

}  // namespace treacle
