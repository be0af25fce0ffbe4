#pragma once

#include "library_csr.hpp"
#include "treacle/linear/bucket_multigrid.hpp"

#include <memory>
#include <span>
#include <vector>

namespace treacle {

/// What a cycle is made of. All must outlive it.
struct LibraryCycle {
  std::span<const double> inverse;  // 1 / A_ii; zero (D = 1 only): not an unknown, P has no such row
  std::span<const Buffer<std::uint32_t, Cuda>> members;  // BucketLevels::begin of the levels that are wanted
  CycleSweeps sweeps;
};

/// The bucket multigrid of [K23 sect. 3.2] and [O23 eqs. (12)-(17)], D numbers per bucket, as a user of the CUDA
/// libraries writes it: coarse operators by cusparseSpGEMM, all products by cusparseSpMV, double precision.
template <int D>
class LibraryMultigrid {
 public:
  /// The matrix must outlive this.
  void setup(Context<Cuda>&, cusparseHandle_t, const ScalarCsr& a, const LibraryCycle&, cusparseSpMVAlg_t);

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
