#pragma once

#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/linear/hat_cycle.hpp"
#include "treacle/linear/joined_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace treacle {

/// MGCG(m, n) of [O23 eqs. (12)-(17)] for one number per particle, on any assembled matrix:
///   M = D^-1 + P_1 L_1^-1 R_1,   A_{l+1} = R_{l+1} A_l P_{l+1},
/// P copying a cell's number to its members, R = P^T, and L_l^-1 a V-cycle of n Jacobi sweeps before and after the
/// coarse correction, 2 n on the last level. The sweeps divide by half the absolute row sums [K23 eq. (41)], with
/// which they amplify nothing, whatever the signs. So the cycle is that of [K23], on numbers instead of vectors.
///
/// Particles whose rows are empty are not unknowns: M neither reads them nor changes them (z = 0), and cells that
/// hold no others get no correction. T is the precision of everything inside; on a device operators are formed in
/// double.
///
/// An apply() reads each level's matrix 2 n times. On a device it is a fixed series of kernels on fixed memory: it
/// can be captured into a graph.
template <class T, class Backend = Cpu>
class CellMultigrid {
  static constexpr bool onDevice = !std::is_same_v<Backend, Cpu>;
  using Members = Buffer<std::uint32_t, Backend>;

 public:
  /// A process's cells of the first level, its own and those of ghosts, in a matrix whose ghosts' rows are empty.
  struct SharedCells {
    std::span<const std::uint32_t> members;
    JoinedRows rows;
  };

  /// `a`: symmetric positive (semi-)definite; nothing refers to its empty rows. `cells`: per level the first
  /// member of each cell and the end, particles on the first level, else cells of the level before
  /// (BucketLevels::begin); they must outlive the last apply(). The first `m` levels are used; 0: all. n >= 1
  /// sweeps. With `shared`, in a simulation that processes share, `cells` are those of all.
  void setup(Context<Backend>& context, const BlockCsr<1, double, Backend>& a, std::span<const Members> cells,
             int m, int n, const SharedCells* shared = nullptr) {
    inverseDiagonal_.resize(context, a.rows());
    hatValues<T, 1>(context, a, {}, inverseDiagonal_);
    const std::size_t count = m == 0 ? cells.size() : std::min(cells.size(), static_cast<std::size_t>(m));
    std::vector<std::span<const std::uint32_t>> members(cells.begin(), cells.begin() + count);
    const CycleSweeps sweeps{.finest = n, .middle = n, .coarsest = 2 * n};
    BlockCsr<1, double, Backend>& coarse = shared ? part_ : finest_;
    const std::span<const std::uint32_t> ofParticles = shared ? shared->members : members[0];
    if constexpr (onDevice)
      spgemm_.compute(context, a, ofParticles, coarse);
    else
      coarsen<1, double>(context, a, ofParticles, coarse);
    if (shared) joinRows<1>(context, part_, shared->rows, finest_);
    if constexpr (onDevice)
      cycle_.setup(context, finest_, std::move(members), sweeps, &spgemm_);
    else
      cycle_.setup(context, finest_, std::move(members), sweeps);
  }

  /// z = M r, per particle
  void apply(Context<Backend>& context, std::span<const double> r, std::span<double> z) {
    cycle_.apply(context, {reinterpret_cast<const Vec<1, T>*>(inverseDiagonal_.data()), inverseDiagonal_.size()},
                 {reinterpret_cast<const Vec<1>*>(r.data()), r.size()},
                 {reinterpret_cast<Vec<1>*>(z.data()), z.size()});
  }

  std::size_t levelCount() const { return cycle_.levelCount(); }
  std::size_t bytes() const {
    return inverseDiagonal_.bytes() + part_.bytes() + finest_.bytes() + cycle_.bytes() + spgemm_.bytes();
  }

 private:
  Buffer<T, Backend> inverseDiagonal_;          // of the particles
  BlockCsr<1, double, Backend> finest_, part_;  // A_1, and this process's part of it
  BucketMultigrid<1, T, Backend> cycle_;
  DeviceOnly<GalerkinSpgemm<1>, Backend> spgemm_;
};

}  // namespace treacle
