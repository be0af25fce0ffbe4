#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/method/pair_sums.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// A = rho/dt I + V + C Lambda C^T applied from pair sums [K23 eq. (16)], walls at rest. What stays the same
/// through a solve is kept: one number per pair and term, from which a product needs no root; directions come from
/// the positions. Per fluid particle that is about 0.5 kB in 2D and 2.5 kB in 3D, read once per product.
template <int D>
class MphOperator {
 public:
  /// Computes the pair coefficients. `pairs` and the terms' spans must outlive the products.
  void prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms);

  /// y = A u, per fluid particle.
  void multiply(Context<Cpu>&, std::span<const Vec<D>> u, std::span<Vec<D>> y);

  std::size_t bytes() const {
    return nearStart_.bytes() + farStart_.bytes() + near_.bytes() + far_.bytes() + q_.bytes();
  }

 private:
  void countEntries();
  void viscosityAndDivergence(std::span<const Vec<D>> u, std::span<Vec<D>> y);
  void wallDivergence(std::span<const Vec<D>> u);
  void addGradient(std::span<Vec<D>> y);

  const MphPairs<D>* pairs_ = nullptr;
  WallTerms<D> terms_{};
  // Eight numbers, one per lane, for entries of the fluid clusters' lists; starts count entries.
  Buffer<std::uint64_t> nearStart_, farStart_;
  Buffer<double> near_;  // near fluid, then near walls: 1/r [1/m], from which both terms follow
  Buffer<double> far_;   // far fluid: c of the viscous block c d d^T
  Buffer<double> q_;     // lambda C^T u, per particle
};

}  // namespace treacle
