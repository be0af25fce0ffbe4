#pragma once

#include "treacle/linear/hat_multigrid.hpp"
#include "treacle/linear/spectral_estimate.hpp"
#include "treacle/precondition/element_bits.hpp"
#include "treacle/precondition/hat_grid.hpp"
#include "treacle/precondition/particle_products.hpp"

#include <span>

namespace treacle {

/// Degrees of the Chebyshev smoothers.
struct ProjectionDegrees {
  int pressure = 0;  // of S' on the particles
  int grid = 0;      // of S' on the background grids
  int velocity = 0;  // of rho/dt I + V on the particles

  bool operator==(const ProjectionDegrees&) const = default;
};

/// What the projected multigrid takes from the materials and the lattice alone, by class (viscosity_classes.hpp).
struct ProjectionConstants {
  double weight[ViscosityClasses::most];  // w [m3 s/kg]: inverse diagonal of rho/dt I + V in a full lattice
  double lambda[ViscosityClasses::most];  // lambda [Pa s], at least so large that S' stays finite
  // Largest lambda times largest w times (C^T C)_kk in a full lattice, of the classes that are materials: how much
  // stiffer the bulk viscosity is.
  double stiffness;
  double resistance;  // V's mean diagonal in a full lattice, over the viscosity [1/m2]
  double extent;      // of the domain, in spacings
  BulkShare share;
  bool severalFluids;

  /// `shift` of S' in units of 1/lambda.
  template <class T>
  ProjectionTable<T> table(double shift = pressureShift) const;
};
template <int D>
ProjectionConstants projectionConstants(const MphPairs<D>& pairs);

/// Whether 32 bits are too few for the elements of C (element_bits.hpp).
template <int D>
bool isTooStiffToPack(const MphPairs<D>& pairs) {
  return projectionConstants(pairs).stiffness > mostPackedStiffness<D>;
}

/// In stiffer systems what single precision rounds in S' is as large as its least eigenvalues, and the
/// preconditioner is no longer positive definite.
inline constexpr double mostSingleStiffness = 1e5;

/// The degrees that pay: those that `chosen` leaves at zero.
ProjectionDegrees chooseDegrees(ProjectionDegrees chosen, const ProjectionConstants& constants);

/// Preconditioner of A = K0 + C Lambda C^T, K0 = rho/dt I + V, that works on divergence-free and other velocities
/// apart (docs/solver.md). With W = diag(w), S' of projection_terms.hpp, Q = V-cycle for S'^-1 (particles, then
/// hat functions on the background grids) and B = V-cycle for K0^-1 (likewise):
///   p = Q C^T W r,  y = B (r - C p),  q = Q (C^T y - Lambda^-1 p),  z = y - W C q.
/// Symmetric and positive definite; T is the precision of everything inside.
template <int D, class T, class Backend = Cpu>
class ProjectedMultigrid {
 public:
  ProjectedMultigrid() = default;
  ProjectedMultigrid(const ProjectedMultigrid&) = delete;  // its products point to its pairs

  /// What `pairs` points to, `terms` and `a` (prepared) must outlive the last apply(). `kept`: the largest
  /// eigenvalue of the scaled S', if it is known from earlier steps; else it is put there. `mostWhole`: as
  /// HatOptions.
  void setup(Context<Backend>&, const MphPairs<D>& pairs, const WallTerms<D>& terms,
             const MphOperator<D, Backend>& a, const ProjectionDegrees& degrees, KeptEigenvalue* kept = nullptr,
             std::uint64_t mostWhole = anyNumber);
  void apply(Context<Backend>&, std::span<const Vec<D>> r, std::span<Vec<D>> z);

  std::size_t gridLevels() const { return pressureGrids_.levelCount(); }
  std::size_t bytes() const;

 private:
  void allocate(Context<Backend>&, std::size_t fluid, std::size_t active);
  void setupGrids(Context<Backend>&, const WallTerms<D>&, const MphOperator<D, Backend>&,
                  const ProjectionTable<double>&, std::uint64_t mostWhole);
  PressureVectors<T, Backend> pressureVectors(int correction) {
    return {pressureResidual_.data(), products_.scalars(correction), p_.data()};
  }
  SmootherVectors<Gathered<D, T>> velocityVectors(int correction) {
    return {velocityResidual_.data(), correction_[correction].data(), y_.data()};
  }
  ScalarField<T, Backend> pressureCycle(Context<Backend>&);
  void velocityCycle(Context<Backend>&);

  void findClasses(Context<Backend>&, const ProjectionConstants&);

  MphPairs<D> pairs_;                    // with classes of its own where several fluids meet
  Buffer<double, Backend> resisting_;    // per fluid particle, there: the viscosity that resists it [Pa s]
  Buffer<std::uint8_t, Backend> class_;  // per active particle, there
  ProjectionTable<T> table_;
  ProjectionDegrees degrees_;
  ParticleProducts<D, T, Backend> products_;
  HatTransfer<D, T, Backend> transfer_;
  HatNodes<D, Backend> pressureNodes_, velocityNodes_;
  Buffer<std::conditional_t<std::is_same_v<Backend, Cuda>, T, Vec<D, T>>, Backend> galerkinWorkspace_;
  Buffer<ViscousMoments<D, T>, Backend> moments_;
  BlockCsr<1, double, Backend> pressureMatrix_;
  BlockCsr<D, double, Backend> velocityMatrix_;
  HatMultigrid<D, T, Backend> pressureGrids_;
  HatMultigrid<D, T, Backend, D> velocityGrids_;
  SpectralEstimate<T, Backend> lambdaMax_;
  Buffer<T, Backend> inversePressure_;            // diagonal of S'
  Buffer<Block<D, T>, Backend> inverseVelocity_;  // diagonal blocks of K0
  Buffer<T, Backend> pressureResidual_, p_;
  Buffer<Gathered<D, T>, Backend> velocityResidual_, y_, correction_[2];
};

}  // namespace treacle
