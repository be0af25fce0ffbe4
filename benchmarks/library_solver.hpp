#pragma once

#include "library_krylov.hpp"
#include "library_multigrid.hpp"
#include "treacle/core/block.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/search/buckets.hpp"

#include <span>
#include <string>

namespace treacle {

/// A solver of plain cuSPARSE and cuBLAS calls in double precision: the baseline of MPH-I.
enum class LibraryMethod {
  MultigridCr,    // MGCR of [K23 eqs. (21)-(32)] with the bucket multigrid, the sweeps of the authors' program
  Cr,             // without preconditioner
  BlockJacobiCg,  // inverses of the diagonal blocks, which no library has: own kernel
};

template <int D>
class LibrarySolver {
 public:
  LibrarySolver(Context<Cuda>& context, LibraryMethod method, cusparseSpMVAlg_t algorithm)
      : context_(context),
        method_(method),
        algorithm_(algorithm),
        krylov_(context, method == LibraryMethod::BlockJacobiCg ? KrylovKind::Cg : KrylovKind::Cr) {}

  /// Preconditioner and products. `a` and the keys of the fluid particles (CellRanges::key) must outlive this.
  void setup(const MphPairs<D>&, const WallTerms<D>&, const ScalarCsr& a, std::span<const std::uint64_t> key);

  /// Prepares solve(), which starts from u and writes the solution there, for these very spans.
  void record(std::span<const Vec<D>> b, std::span<Vec<D>> u, const StoppingRule&);
  SolveReport solve() { return krylov_.solve(); }

  /// How it worked: libraries and loop.
  std::string libraries() const { return krylov_.libraries(); }
  const std::string& loop() const { return krylov_.loop(); }

 private:
  LibraryKrylov::Preconditioner preconditioner();

  Context<Cuda>& context_;
  LibraryMethod method_;
  cusparseSpMVAlg_t algorithm_;
  LibraryKrylov krylov_;
  LibraryProduct byA_;
  BucketLevels<Cuda> buckets_;
  LibraryMultigrid<D> multigrid_;
  Buffer<Block<D>, Cuda> diagonal_, blockInverse_;
  Buffer<Vec<D>, Cuda> inverse_;
};

}  // namespace treacle
