#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace treacle {

/// Galerkin operators P^T A P of B unknowns per row as two sparse matrix products of cuSPARSE [O23 eq. (15)].
/// P^T is the summation over the members of each coarse row. Takes any assembled matrix; the price are scalar
/// copies of A, P and P^T, which it keeps from call to call with all workspace.
template <int B>
class GalerkinSpgemm {
 public:
  GalerkinSpgemm();
  GalerkinSpgemm(GalerkinSpgemm&&) noexcept;
  GalerkinSpgemm& operator=(GalerkinSpgemm&&) noexcept;
  ~GalerkinSpgemm();

  /// `members`: first fine row of each coarse one, and the end; device memory. The blocks of `coarse` are those
  /// that some product adds to, zero or not: the diagonal is among them wherever a fine row with a diagonal has a
  /// weight. Errors: RunError when a matrix has more nonzeros than cuSPARSE can count, or cuSPARSE finds no way to
  /// multiply it; std::bad_alloc.
  void compute(Context<Cuda>&, const BlockCsr<B, double, Cuda>& fine, std::span<const std::uint32_t> members,
               BlockCsr<B, double, Cuda>& coarse);

  /// Device memory that is kept [B].
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace treacle
