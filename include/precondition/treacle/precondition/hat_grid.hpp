#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/precondition/projection_terms.hpp"
#include "treacle/precondition/viscous_moments.hpp"

#include <span>

namespace treacle {

/// Between the particles and the finest background grid: multilinear hat functions P on the corners of the search
/// cells (HatCells). Spans "per particle" have activeCount, "per fluid particle" fluidCount elements; node vectors
/// have one number per node for pressures, D for velocities.

template <int D>
class NearProducts;

enum class HatsOn { Active, Fluid };

/// The corners of the cells that hold active particles, or fluid. Where processes share the simulation and there
/// are more than `mostWhole`, each has those at the lower corners of its cells and ghosts of others, which all
/// that its particles, ghosts included, touch are among.
template <int D, class Backend>
void findHatNodes(Context<Backend>&, const SortedParticles<D>& pairs, HatsOn what, HatNodes<D, Backend>& nodes,
                  std::uint64_t mostWhole = anyNumber);

/// Galerkin operator P^T S' P of the pressures, from pair sums; S' itself is not needed. Workspace in the
/// precision T: `columns`, the 3^D vectors of C P per fluid particle; on a device, where `near` has the lists of
/// these pairs, `parts`, 340 numbers per node in 2D and 5896 in 3D.
template <int D, class T>
void pressureGalerkin(Context<Cpu>&, const MphPairs<D>& pairs, const ProjectionTable<double>& table,
                      const HatNodes<D>& nodes, Buffer<Vec<D, T>>& columns, BlockCsr<1>& s);
template <int D, class T>
void pressureGalerkin(Context<Cuda>&, const MphPairs<D>& pairs, const NearProducts<D>& near,
                      const ProjectionTable<double>& table, const HatNodes<D, Cuda>& nodes, Buffer<T, Cuda>& parts,
                      BlockCsr<1, double, Cuda>& s);

/// Hats bend between the particles of a pair, whose difference their gradients then overestimate: in three
/// dimensions this factor saves one iteration in twelve; anything from 0.6 to 1 does.
inline constexpr double viscousGalerkinFactor = 0.75;

/// Nearly P^T (rho/dt I + V) P of the velocities: differences of hats between two particles are taken from their
/// gradients, so that a particle's pairs enter by their moments and nodes couple to adjacent ones alone (pattern
/// of reach 1). `moments`: workspace, per fluid particle; on a device also `parts`, D^2 4^D numbers per node.
template <int D, class T>
void viscousGalerkin(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms, const HatNodes<D>& nodes,
                     Buffer<ViscousMoments<D, T>>& moments, BlockCsr<D>& a);
template <int D, class T>
void viscousGalerkin(Context<Cuda>&, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                     const HatNodes<D, Cuda>& nodes, Buffer<ViscousMoments<D, T>, Cuda>& moments,
                     Buffer<T, Cuda>& parts, BlockCsr<D, double, Cuda>& a);

/// The transfers themselves, in the precision of a preconditioner. What is restricted is summed over processes.
template <int D, class T, class Backend = Cpu>
class HatTransfer;

template <int D, class T>
class HatTransfer<D, T, Cpu> {
 public:
  /// `particles` must outlive the transfers; all nodes given later stand on their search cells.
  void prepare(Context<Cpu>&, const SortedParticles<D>& particles);
  /// b = P^T r; r per particle.
  void restrict(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> r, std::span<T> b) const;
  /// The same for particles that are all fluid. `sums`: workspace, sumsPerNode numbers per node.
  void restrictFluid(Context<Cpu>& context, const HatNodes<D>& nodes, std::span<const T> r, Buffer<T>&,
                     std::span<T> b) const {
    restrict(context, nodes, r, b);
  }
  static constexpr std::size_t sumsPerNode = 0;
  /// The same for velocities; r per fluid particle.
  void restrict(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const Gathered<D, T>> r, std::span<T> b) const;
  /// z = P e and x += z.
  void prolong(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e, ScalarField<T, Cpu> z,
               std::span<T> x) const;
  void prolong(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e, std::span<Gathered<D, T>> z,
               std::span<Gathered<D, T>> x) const;
  /// x += P e
  void addProlonged(Context<Cpu>&, const HatNodes<D>& nodes, std::span<const T> e, std::span<T> x) const;
  std::size_t bytes() const { return corner_.bytes() + place_.bytes(); }

 private:
  static constexpr int corners = 1 << D;
  const SortedParticles<D>* pairs_ = nullptr;
  Buffer<std::uint32_t> corner_;  // per particle: the lattice points at the corners of its cell
  Buffer<Vec<D, T>> place_;       // per particle: where it stands in there, 0 … 1 per axis
};

template <int D, class T>
class HatTransfer<D, T, Cuda> {
 public:
  void prepare(Context<Cuda>&, const SortedParticles<D>& pairs);
  void restrict(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const T> r, std::span<T> b) const;
  void restrictFluid(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const T> r, Buffer<T, Cuda>& sums,
                     std::span<T> b) const;
  static constexpr std::size_t sumsPerNode = 1 << D;
  void restrict(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const Gathered<D, T>> r,
                std::span<T> b) const;
  void prolong(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const T> e, ScalarField<T, Cuda> z,
               std::span<T> x) const;
  void prolong(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const T> e, std::span<Gathered<D, T>> z,
               std::span<Gathered<D, T>> x) const;
  void addProlonged(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, std::span<const T> e, std::span<T> x) const;
  std::size_t bytes() const { return place_.bytes(); }

 private:
  const SortedParticles<D>* pairs_ = nullptr;
  Buffer<Vec<D, T>, Cuda> place_;
};

}  // namespace treacle
