#pragma once

#include "library_csr.hpp"
#include "treacle/search/buckets.hpp"

#include <memory>
#include <span>
#include <vector>

namespace treacle {

/// The bucket multigrid of [K23 sect. 3.2] as a user of the CUDA libraries writes it, with the sweeps and the
/// diagonal of the authors' program: coarse operators by cusparseSpGEMM, all products by cusparseSpMV, double
/// precision.
template <int D>
class LibraryMultigrid {
 public:
  /// `inverse`: 1 / A_ii. It, the matrix and the levels must outlive this.
  void setup(Context<Cuda>&, cusparseHandle_t, const ScalarCsr& a, std::span<const double> inverse,
             const BucketLevels<Cuda>&, cusparseSpMVAlg_t);

  /// z = diag(inverse) r + P M^0 R r [K23 eq. (43)].
  void apply(std::span<const double> r, std::span<double> z);

 private:
  struct Level {
    ScalarCsr a, restriction, prolongation;  // the transfers from and to the next finer level
    LibraryProduct byA, byRestriction, byProlongation;
    Buffer<double, Cuda> inverse, b, x, product;  // extended Jacobi, right-hand side, iterate, A x
    int sweeps = 0;
  };

  void sweep(Level& level);
  void cycle(std::size_t level);

  Context<Cuda>* context_ = nullptr;
  ScalarProduct product_;
  ScalarCsr ap_;
  std::span<const double> inverse_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace treacle
