#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace treacle {

/// Galerkin operators R A P, P = R^T the summation over members, as two sparse matrix products of cuSPARSE. Takes
/// any assembled matrix; the price are scalar copies of A, P and R, which it keeps from call to call with all
/// workspace.
template <int D>
class GalerkinSpgemm {
 public:
  GalerkinSpgemm();
  GalerkinSpgemm(GalerkinSpgemm&&) noexcept;
  GalerkinSpgemm& operator=(GalerkinSpgemm&&) noexcept;
  ~GalerkinSpgemm();

  /// `members`: first fine row of each coarse one, and the end; device memory. Errors: RunError when the matrix
  /// has more nonzeros than cuSPARSE can count, or cuSPARSE finds no way to multiply it; std::bad_alloc.
  void compute(Context<Cuda>&, const BlockCsr<D, double, Cuda>& fine, std::span<const std::uint32_t> members,
               BlockCsr<D, double, Cuda>& coarse);

  /// Device memory that is kept [B].
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace treacle
