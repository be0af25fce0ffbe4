#pragma once

#include "library_krylov.hpp"
#include "library_multigrid.hpp"

#include <span>
#include <string>

namespace treacle {

/// CG, without preconditioner or with MGCG(m, n) of [O23 eqs. (12)-(17)], on any matrix of numbers by plain
/// cuSPARSE and cuBLAS calls in double precision: the baseline of ISPH.
class LibraryMgcg {
 public:
  LibraryMgcg(Context<Cuda>& context, cusparseSpMVAlg_t algorithm)
      : context_(context), algorithm_(algorithm), krylov_(context, KrylovKind::Cg) {}

  /// Products and preconditioner. `inverse` (1 / A_ii, zero: not an unknown), `members` (of m levels; none: plain
  /// CG) and the matrix must outlive this. n sweeps before and after each coarse correction, 2 n on the last
  /// level.
  void setup(const ScalarCsr& a, std::span<const double> inverse,
             std::span<const Buffer<std::uint32_t, Cuda>> members, int n);

  /// Prepares solve(), which starts from x and writes the solution there, for these very spans.
  void record(std::span<const double> b, std::span<double> x, const StoppingRule&);
  SolveReport solve() { return krylov_.solve(); }

  /// How it worked: libraries and loop.
  std::string libraries() const { return krylov_.libraries(); }
  const std::string& loop() const { return krylov_.loop(); }

 private:
  Context<Cuda>& context_;
  cusparseSpMVAlg_t algorithm_;
  LibraryKrylov krylov_;
  LibraryProduct byA_;
  LibraryMultigrid<1> multigrid_;
  bool preconditioned_ = false;
};

}  // namespace treacle
