#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/precondition/packed_rows.hpp"
#include "treacle/precondition/projection_terms.hpp"
#include "treacle/precondition/staged_lists.hpp"

#include <span>

namespace treacle {

/// The sums over neighbours that a preconditioner is made of, in its own precision T. `store` is called once per
/// own particle with the sum; which ones there are: projection_terms.hpp. Of what is gathered, own particles'
/// values are enough: a product brings those of ghosts.
template <int D, class T, class Backend = Cpu>
class ParticleProducts;

/// How far C and C^T of a preconditioner reach, in h_p. In single precision a corrected gradient leaves out the
/// pairs whose terms are next to nothing, a fifth of them in three dimensions, in all products alike
/// (docs/solver.md).
template <class T, int D>
double productReach(const MphPairs<D>& pairs) {
  return std::is_same_v<T, float> && pairs.renormalisation ? slopeReach(pairs.terms.scheme.kind) : 1;
}

/// As MphOperator<D, Cpu>: one number per pair and term is kept. In single precision schur() has elements of C in
/// few bits, with which S' is still symmetric (PackedRows): fewer operations, and no position and no B is read.
/// Single precision alone leaves out what does not act along walls (MphPairs::alongWall), on devices, too.
template <int D, class T>
class ParticleProducts<D, T, Cpu> {
 public:
  /// `pairs` and the terms' spans must outlive the products. `a`: prepared.
  void prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms, const MphOperator<D, Cpu>& a);

  /// store(i, (C q)_i) per fluid particle; q per particle.
  template <class Store>
  void gradient(Context<Cpu>&, ScalarField<T, Cpu> q, const Store& store) const;
  /// store(k, (C^T u)_k) per particle, walls at rest; u per fluid particle.
  template <class Store>
  void divergence(Context<Cpu>&, VectorField<D, T, Cpu> u, const Store& store) const;
  /// store(k, (C^T W C q)_k) per particle; vectors() is workspace.
  template <class Store>
  void schur(Context<Cpu>&, const ProjectionTable<T>& table, ScalarField<T, Cpu> q, const Store& store);
  /// store(i, ((rho/dt I + V) u)_i) per fluid particle.
  template <class Store>
  void viscous(Context<Cpu>&, Gathered<D, T>* u, const Store& store) const;

  /// Inverse diagonal of S' per particle [Pa s], zero for ghosts, and inverse diagonal blocks of rho/dt I + V per
  /// fluid particle.
  void inverseDiagonals(Context<Cpu>&, const ProjectionTable<T>& table, std::span<T> pressure,
                        std::span<Block<D, T>> velocity) const;

  /// Per fluid particle, ghosts included: the viscosity of a full lattice in which the pairs' mean resistance
  /// would be what it is, `resistance` being that of the lattice over its viscosity [1/m2].
  void resistingViscosity(Context<Cpu>&, double resistance, std::span<double> viscosity) const;

  /// What `gradient` and `divergence` gather: two fields of scalars and one of vectors, valid until prepare() is
  /// called again.
  ScalarField<T, Cpu> scalars(int which = 0) { return {scalars_[which].data()}; }
  VectorField<D, T, Cpu> vectors() { return {vectors_.data()}; }
  /// scalars(0) = x, per particle; vectors() = u, or W u, per fluid particle.
  void gather(Context<Cpu>&, std::span<const T> x);
  void gather(Context<Cpu>&, std::span<const Gathered<D, T>> u);
  void gatherWeighted(Context<Cpu>&, const ProjectionTable<T>& table, std::span<const Vec<D>> u);
  std::size_t bytes() const;
  /// Pairs of columns that schur() passes in single precision.
  struct PackedPairs {
    double gradient = 0, divergence = 0;
  };
  PackedPairs packedPairs() const;

 private:
  void sumGradients();
  bool hasSmoothWalls() const { return std::is_same_v<T, float> && pairs_->slips(); }
  /// f.operator()<Renormalised, Smooth>(), for loops whose roundings depend on what else they could compute.
  template <class F>
  void withWalls(F&& f) const {
    if (hasSmoothWalls())
      f.template operator()<true, true>();
    else
      withRenormalisation(*pairs_, [&]<bool Renormalised>() { f.template operator()<Renormalised, false>(); });
  }
  // For schur() in single precision.
  static constexpr bool packed = std::is_same_v<T, float>;
  void pack();
  template <class Store>
  void packedSchur(const Context<Cpu>&, const ProjectionTable<T>& table, ScalarField<T, Cpu> q,
                   const Store& store);
  // Where the pairs have B.
  void renormalise();
  void takeAlongWalls();

  const MphPairs<D>* pairs_ = nullptr;
  WallTerms<D> terms_{};
  Buffer<T> scalars_[2];
  Buffer<Gathered<D, T>> vectors_;
  Buffer<Vec<D, T>> position_;  // from the domain's corner [m]
  // D times eight numbers per cluster: positions likewise, and sums of B g d over all neighbours and over walls.
  Buffer<T> fluidLanes_, wallLanes_, gradient_, wallGradient_;
  // Eight numbers per list entry, one per lane; starts count entries.
  Buffer<std::uint64_t> viscousStart_, pressureStart_, wallStart_;
  Buffer<T> viscous_;              // near and far fluid of fluid clusters: c of the viscous block c d d^T
  Buffer<T> pressure_;             // near fluid, then near walls: g of -e w' = g d
  Buffer<T> wall_;                 // near fluid of wall clusters: likewise
  Buffer<Block<D, T>> selfBlock_;  // diagonal block of rho/dt I + V
  Buffer<SymmetricBlock<D, T>> renormalisation_;  // B of the pairs, if they have it
  PackedRows gradientRows_, divergenceRows_;      // of C, and of C^T for fluid pressures; without the diagonal
  PackedRows wallRows_;                           // of C^T for those of walls
  T unit_ = 0;                                    // of unpacked elements [1/m]
};

/// As MphOperator<D, Cuda>, whose lists it uses.
template <int D, class T>
class ParticleProducts<D, T, Cuda> {
 public:
  void prepare(Context<Cuda>&, const MphPairs<D>& pairs, const WallTerms<D>& terms, const MphOperator<D, Cuda>& a);
  template <class Store>
  void gradient(Context<Cuda>&, ScalarField<T, Cuda> q, const Store& store) const;
  template <class Store>
  void divergence(Context<Cuda>&, VectorField<D, T, Cuda> u, const Store& store) const;
  template <class Store>
  void schur(Context<Cuda>&, const ProjectionTable<T>& table, ScalarField<T, Cuda> q, const Store& store);
  template <class Store>
  void viscous(Context<Cuda>&, Gathered<D, T>* u, const Store& store) const;
  void inverseDiagonals(Context<Cuda>&, const ProjectionTable<T>& table, std::span<T> pressure,
                        std::span<Block<D, T>> velocity) const;
  void resistingViscosity(Context<Cuda>&, double resistance, std::span<double> viscosity) const;
  ScalarField<T, Cuda> scalars(int which = 0);
  VectorField<D, T, Cuda> vectors();
  void gather(Context<Cuda>&, std::span<const T> x);
  void gather(Context<Cuda>&, std::span<const Gathered<D, T>> u);
  void gatherWeighted(Context<Cuda>&, const ProjectionTable<T>& table, std::span<const Vec<D>> u);
  std::size_t bytes() const;

 private:
  /// Whether what is gathered stands beside the position: elsewhere no position is read (StagedLists), or all of
  /// its digits are.
  bool isPlaced() const { return std::is_same_v<T, float> && !pairs_->renormalisation; }

  const MphPairs<D>* pairs_ = nullptr;
  const MphOperator<D, Cuda>* a_ = nullptr;
  StagedLists<D> staged_;  // in single precision with B
  Buffer<T, Cuda> scalars_[2];
  Buffer<Gathered<D, T>, Cuda> vectors_;  // those of walls are zero
  Buffer<PlacedScalar, Cuda> placedScalars_[2];
  Buffer<PlacedVector<D>, Cuda> placedVectors_;  // likewise
  Buffer<Block<D, T>, Cuda> selfBlock_;          // diagonal block of rho/dt I + V
};

}  // namespace treacle
