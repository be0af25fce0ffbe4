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
/// iteration [K23 eq. (42)]. D numbers per particle and bucket: as many as space has dimensions, or one in any
/// space. T is the precision of everything inside; the vectors outside are double.
template <int D, class T, class Backend = Cpu>
class BucketMultigrid;

template <int D, class T>
class BucketMultigrid<D, T, Cpu> {
 public:
  /// `finest`: A^0 = R A P, one row per level-0 bucket; rows without entries get no correction. `members`: per
  /// level the first member of each bucket and the end (BucketLevels::begin); they must outlive the last apply().
  void setup(Context<Cpu>&, const BlockCsr<D>& finest, std::vector<std::span<const std::uint32_t>> members,
             const CycleSweeps& sweeps);

  /// z = diag(inverse) r + P M^0 R r, per particle. `inverse`: D^-1 of the particles; zero: not an unknown, P has
  /// no such row.
  void apply(Context<Cpu>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);
  /// z = P M^0 R r and x += z, per particle: the coarse correction of a smoother on the particles.
  void correct(Context<Cpu>&, std::span<const Gathered<D, T>> r, std::span<Gathered<D, T>> z,
               std::span<Gathered<D, T>> x);

  std::size_t levelCount() const { return levels_.size(); }
  const BlockCsr<D, T>& matrix(std::size_t level) const { return levels_[level].a; }
  std::size_t bytes() const;

 private:
  struct Level {
    BlockCsr<D, T> a;
    Buffer<Vec<D, T>> inverseDiagonal;
    Buffer<Vec<D, T>> b, x, next;  // right-hand side, iterate, and where a sweep writes
  };

  template <class Value>
  void restrict(const Value& value);
  void cycle(Context<Cpu>& context, std::size_t level);
  void sweep(Level& level);

  std::vector<Level> levels_;
  std::vector<std::span<const std::uint32_t>> members_;
  CycleSweeps sweeps_;
};

template <int D>
class GalerkinSpgemm;
template <int D, class T>
struct CycleLevel;

/// The same on a device. An apply() is a fixed series of kernels, two per sweep and level at most; from the first
/// level with at most `denseUnknowns` unknowns on, if there is one, the whole rest of the cycle is one symmetric
/// matrix, made at setup by running the cycle on the unit vectors: small levels would otherwise take a launch per
/// sweep.
template <int D, class T>
class BucketMultigrid<D, T, Cuda> {
 public:
  static constexpr std::uint32_t denseUnknowns = 1100;

  /// As on the CPU. With `spgemm` the coarse operators are its products, else sums of entries (coarsen).
  void setup(Context<Cuda>&, const BlockCsr<D, double, Cuda>& finest,
             std::vector<std::span<const std::uint32_t>> members, const CycleSweeps& sweeps,
             GalerkinSpgemm<D>* spgemm = nullptr);
  void apply(Context<Cuda>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);
  void correct(Context<Cuda>&, std::span<const Gathered<D, T>> r, std::span<Gathered<D, T>> z,
               std::span<Gathered<D, T>> x);

  std::size_t levelCount() const { return levels_.size(); }
  /// Level r > 0: A^r in double precision.
  const BlockCsr<D, double, Cuda>& galerkin(std::size_t level) const { return levels_[level].galerkin; }
  std::size_t bytes() const;

 private:
  struct Level {
    BlockCsr<D, double, Cuda> galerkin;  // empty at level 0, where it is the caller's
    BlockCsr<D, T, Cuda> a;              // the same in the cycle's precision
    Buffer<Vec<D, T>, Cuda> inverseDiagonal;
    Buffer<Vec<D, T>, Cuda> b, x, next;  // right-hand side, iterate, and where a sweep writes
    Buffer<std::uint32_t, Cuda> parent;  // per member (particle or finer bucket): its bucket
    std::span<const std::uint32_t> members;
    int sweeps = 0;
  };

  CycleLevel<D, T> view(std::size_t level) const;
  void buildLevel(Context<Cuda>&, std::size_t level, const BlockCsr<D, double, Cuda>& a);
  void buildDense(Context<Cuda>&);
  void cycle(Context<Cuda>&, std::size_t level);

  std::vector<Level> levels_;
  std::size_t denseLevel_ = 0;  // levels_.size(): none
  Buffer<T, Cuda> dense_;       // of denseLevel_, row-major
};

/// Galerkin operator of the next coarser level by summation, A^{r+1} = R A^r P [K23 eq. (38)]. `members`: first
/// fine row of each coarse one, and the end.
template <int D, class T>
void coarsen(Context<Cpu>&, const BlockCsr<D, T>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T>& coarse);
/// On the device a row may have up to 3^D coarse columns (D = 1: 27), as adjacent buckets do; more: RunError.
template <int D, class T>
void coarsen(Context<Cuda>&, const BlockCsr<D, T, Cuda>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T, Cuda>& coarse);

}  // namespace treacle
