#pragma once

#include "treacle/linear/bucket_cycle.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"

#include <cstdint>
#include <span>
#include <type_traits>
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
///
/// Where processes share a simulation the levels are those of all, whole at every process, and so is all that a
/// cycle does; what it begins with is summed over the processes.
///
/// From the first level with at most `denseUnknowns` unknowns on, if there is one, the whole rest of the cycle is
/// one symmetric matrix, made by running the cycle on the unit vectors: on a device small levels would otherwise
/// take a launch per sweep. An apply() is then a fixed series of kernels on fixed memory.
template <int D, class T, class Backend = Cpu>
class BucketMultigrid {
  static constexpr bool onDevice = std::is_same_v<Backend, Cuda>;

 public:
  using Spgemm = DeviceOnly<GalerkinSpgemm<D>, Backend>;

  explicit BucketMultigrid(std::uint32_t denseUnknowns = onDevice ? 1100 : 0) : denseUnknowns_(denseUnknowns) {}

  /// `finest`: A^0 = R A P, one row per level-0 bucket; rows without entries get no correction. `members`: per
  /// level the first member of each bucket and the end (BucketLevels::begin), in the backend's memory; they must
  /// outlive the last apply(). With `spgemm` the coarse operators are its products, else sums of entries.
  void setup(Context<Backend>&, const BlockCsr<D, double, Backend>& finest,
             std::vector<std::span<const std::uint32_t>> members, const CycleSweeps& sweeps,
             Spgemm* spgemm = nullptr);

  /// z = diag(inverse) r + P M^0 R r, per particle. `inverse`: D^-1 of the particles; zero: not an unknown, P has
  /// no such row.
  void apply(Context<Backend>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r,
             std::span<Vec<D>> z);

  std::uint32_t denseUnknowns() const { return denseUnknowns_; }
  std::size_t levelCount() const { return levels_.size(); }
  /// A^r in the cycle's precision.
  const BlockCsr<D, T, Backend>& matrix(std::size_t level) const { return levels_[level].a; }
  /// On a device, level r > 0: A^r in double precision.
  const DeviceOnly<BlockCsr<D, double, Backend>, Backend>& galerkin(std::size_t level) const {
    return levels_[level].galerkin;
  }
  std::size_t bytes() const;

 private:
  struct Level {
    DeviceOnly<BlockCsr<D, double, Backend>, Backend> galerkin;  // empty at level 0, where it is the caller's
    BlockCsr<D, T, Backend> a;                                   // in the cycle's precision
    Buffer<Vec<D, T>, Backend> inverseDiagonal;
    Buffer<Vec<D, T>, Backend> b, x, next;
    Buffer<std::uint32_t, Backend> parent;
    std::span<const std::uint32_t> members;
    int sweeps = 0;
  };

  std::uint32_t unknowns(std::size_t r) const { return D * levels_[r].a.rows(); }
  BucketLevel<D, T> view(std::size_t r) const;
  void buildMatrix(Context<Backend>&, std::size_t r, const BlockCsr<D, double, Backend>& finest, Spgemm* spgemm);
  void resizeVectors(Context<Backend>&, std::size_t r, std::uint32_t columns);
  void buildDense(Context<Backend>&);
  void cycle(Context<Backend>&, std::size_t r, std::uint32_t columns = 1);

  std::uint32_t denseUnknowns_;
  std::vector<Level> levels_;
  std::size_t denseLevel_ = 0;  // levels_.size(): none
  Buffer<T, Backend> dense_;    // of denseLevel_, row-major
};

}  // namespace treacle
