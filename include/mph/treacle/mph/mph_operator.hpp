#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/near_products.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// A = rho/dt I + V + C Lambda C^T applied from pair sums [K23 eq. (16)], walls at rest. What stays the same
/// through a solve is kept: one number per pair and term, from which a product needs no root; directions come from
/// the positions. Per fluid particle that is about 0.8 kB in 2D and 3 kB in 3D, read once per product.
template <int D, class Backend = Cpu>
class MphOperator;

template <int D>
class MphOperator<D, Cpu> {
 public:
  /// Computes the pair coefficients. `pairs` and the terms' spans must outlive the products.
  void prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms);

  /// y = A u, per own fluid particle.
  void multiply(Context<Cpu>&, std::span<const Vec<D>> u, std::span<Vec<D>> y);

  std::size_t bytes() const {
    return viscousStart_.bytes() + pressureStart_.bytes() + viscous_.bytes() + pressure_.bytes() + q_.bytes() +
           withGhosts_.bytes();
  }

 private:
  void countEntries();
  template <bool Renormalised>
  void viscosityAndDivergence(std::span<const Vec<D>> u, std::span<Vec<D>> y);
  void wallDivergence(std::span<const Vec<D>> u);
  template <bool Renormalised>
  void addGradient(std::span<Vec<D>> y);

  const MphPairs<D>* pairs_ = nullptr;
  WallTerms<D> terms_{};
  // Eight numbers, one per lane, for entries of the fluid clusters' lists; starts count entries. That 1/r alone
  // would give both terms of a near pair does not pay: the arithmetic takes longer than the second number's way to
  // the core.
  Buffer<std::uint64_t> viscousStart_, pressureStart_;
  Buffer<double> viscous_;     // near and far fluid: c of the viscous block c d d^T
  Buffer<double> pressure_;    // near fluid, then near walls: g of -e w' = g d
  Buffer<double> q_;           // lambda C^T u, per particle
  Buffer<Vec<D>> withGhosts_;  // u
};

/// The same on a device, where arithmetic costs less than memory: pair terms are computed from the positions in
/// every product; kept are each particle's self terms, and lists of the neighbours within h_p.
template <int D>
class MphOperator<D, Cuda> {
 public:
  void prepare(Context<Cuda>&, const MphPairs<D>& pairs, const WallTerms<D>& terms);
  void multiply(Context<Cuda>&, std::span<const Vec<D>> u, std::span<Vec<D>> y);
  const NearProducts<D>& near() const { return near_; }
  /// Diagonal block of rho/dt I + V, per fluid particle.
  std::span<const Block<D>> selfBlock() const { return selfBlock_; }
  std::size_t bytes() const {
    return q_.bytes() + selfBlock_.bytes() + selfGradient_.bytes() + withGhosts_.bytes() + near_.bytes();
  }

 private:
  void multiplyRenormalised(Context<Cuda>&, std::span<const Vec<D>> u, std::span<Vec<D>> y);

  const MphPairs<D>* pairs_ = nullptr;
  Buffer<Block<D>, Cuda> selfBlock_;   // diagonal block of rho/dt I + V, per fluid particle
  Buffer<Vec<D>, Cuda> selfGradient_;  // C_ii; empty where the pairs have B
  Buffer<double, Cuda> q_;             // lambda C^T u, per particle
  Buffer<Vec<D>, Cuda> withGhosts_;    // u
  NearProducts<D> near_;
};

}  // namespace treacle
