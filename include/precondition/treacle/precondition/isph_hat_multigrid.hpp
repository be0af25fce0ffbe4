#pragma once

#include "treacle/core/halo.hpp"
#include "treacle/isph/isph_matrix.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "treacle/linear/hat_multigrid.hpp"
#include "treacle/precondition/hat_grid.hpp"

#include <span>

namespace treacle {

/// Gradients of hats overestimate the differences within a pair; anything from 0.8 to 1 does.
inline constexpr double isphGalerkinFactor = 0.9;

/// Nearly P^T A P of a matrix of pairs: differences of hats between two particles are taken from their gradients
/// (moments), and what stands on the diagonal alone is lumped to the nodes' diagonals. Pattern of reach 1.
/// `parts`: workspace.
template <int D, class T>
void isphGalerkin(Context<Cpu>&, const SortedParticles<D>& particles, std::span<const IsphMoments<D>> moments,
                  const HatNodes<D>& nodes, Buffer<T>& parts, BlockCsr<1>& a);
template <int D, class T>
void isphGalerkin(Context<Cuda>&, const SortedParticles<D>& particles, std::span<const IsphMoments<D>> moments,
                  const HatNodes<D, Cuda>& nodes, Buffer<T, Cuda>& parts, BlockCsr<1, double, Cuda>& a);

/// Preconditioner of ISPH's scalar equations (docs/isph.md): a V-cycle of one Jacobi sweep on the particles, with
/// the matrix cut to near neighbours, and of a multigrid of hat functions on the corners of the search cells.
/// Symmetric and positive definite on all particles whose rows are not zero; T is the precision of everything
/// inside.
template <int D, class T, class Backend = Cpu>
class IsphHatMultigrid {
 public:
  IsphHatMultigrid() = default;
  /// Grids of so many unknowns at most are solved by their inverse.
  explicit IsphHatMultigrid(std::uint32_t denseUnknowns) : grids_(denseUnknowns) {}

  /// Arguments must outlive the last apply(). `gridDegree` of the smoother on the grids; `mostWhole`: as
  /// HatOptions.
  void setup(Context<Backend>& context, const SortedParticles<D>& particles, const IsphMatrix<T>& a,
             std::span<const IsphMoments<D>> moments, int gridDegree, std::uint64_t mostWhole = anyNumber) {
    a_ = a;
    fluid_ = particles;
    // Walls have no unknowns here.
    fluid_.activeCount = particles.fluidCount;
    fluid_.ghostWalls = 0;
    fluid_.cells.wallEnd = fluid_.cells.wallBegin;
    x_.resize(context, particles.fluidCount);
    residual_.resize(context, a.rows);
    transfer_.prepare(context, fluid_);
    findHatNodes(context, fluid_, HatsOn::Fluid, nodes_, grids_.mostWhole(mostWhole));
    isphGalerkin(context, fluid_, moments, nodes_, parts_, matrix_);
    giveUp(parts_);
    sums_.resize(context, HatTransfer<D, T, Backend>::sumsPerNode * nodes_.count());
    grids_.setup(context, nodes_, matrix_, {.degree = gridDegree, .reach = 1, .mostWhole = mostWhole});
  }

  /// z = K r; z is zero where rows are. Ghosts are brought once: what is prolonged to them is what their owners
  /// make of the same grid.
  void apply(Context<Backend>& context, std::span<const double> r, std::span<double> z) {
    firstSweep(context, a_, r, x_.span());
    fillGhosts(context, Held::Fluid, x_.data());
    nearResidual(context, a_, r, std::span<const T>(x_), residual_.span());
    transfer_.restrictFluid(context, nodes_, std::span<const T>(residual_), sums_, grids_.rhs());
    grids_.cycle(context);
    transfer_.addProlonged(context, nodes_, grids_.solution(), x_.span());
    lastSweep(context, a_, r, std::span<const T>(x_), z);
  }

  std::size_t gridLevels() const { return grids_.levelCount(); }
  std::size_t bytes() const {
    return x_.bytes() + residual_.bytes() + transfer_.bytes() + nodes_.bytes() + parts_.bytes() + sums_.bytes() +
           matrix_.bytes() + grids_.bytes();
  }

 private:
  IsphMatrix<T> a_;
  SortedParticles<D> fluid_;
  Buffer<T, Backend> x_;         // per fluid particle, ghosts included
  Buffer<T, Backend> residual_;  // of own ones
  HatTransfer<D, T, Backend> transfer_;
  HatNodes<D, Backend> nodes_;
  Buffer<T, Backend> parts_;  // of setup()
  Buffer<T, Backend> sums_;   // of apply()
  BlockCsr<1, double, Backend> matrix_;
  HatMultigrid<D, T, Backend> grids_;
};

}  // namespace treacle
