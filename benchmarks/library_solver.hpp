#pragma once

#include "library_blas.hpp"
#include "library_loop.hpp"
#include "library_multigrid.hpp"
#include "treacle/core/block.hpp"
#include "treacle/method/assemble.hpp"
#include "treacle/method/mph_pairs.hpp"

#include <span>
#include <string>

namespace treacle {

/// A solver of plain cuSPARSE and cuBLAS calls in double precision, a graph of them per iteration: the baseline.
enum class LibraryMethod {
  MultigridCr,    // MGCR of [K23 eqs. (21)-(32)] with the bucket multigrid
  Cr,             // without preconditioner
  BlockJacobiCg,  // inverses of the diagonal blocks, which no library has: own kernel
};

/// A handle of cuSPARSE on a stream.
class CusparseHandle {
 public:
  explicit CusparseHandle(const Context<Cuda>& context) {
    TREACLE_CUSPARSE_CHECK(cusparseCreate(&handle_));
    TREACLE_CUSPARSE_CHECK(cusparseSetStream(handle_, context.stream()));
  }
  CusparseHandle(const CusparseHandle&) = delete;
  ~CusparseHandle() { cusparseDestroy(handle_); }
  operator cusparseHandle_t() const { return handle_; }
  std::string version() const;

 private:
  cusparseHandle_t handle_ = nullptr;
};

/// The scalars that cuBLAS reads and writes, in device memory.
struct LibraryCoefficients {
  double sum, sumOfB;
  double alpha, minusAlpha, beta, one;
};

template <int D>
class LibrarySolver {
 public:
  LibrarySolver(Context<Cuda>& context, LibraryMethod method, cusparseSpMVAlg_t algorithm)
      : context_(context), method_(method), algorithm_(algorithm), cusparse_(context), blas_(context) {}

  /// Preconditioner and products. `a` and the keys of the fluid particles (CellRanges::key) must outlive this.
  void setup(const MphPairs<D>&, const WallTerms<D>&, const ScalarCsr& a, std::span<const std::uint64_t> key);

  /// Prepares solve(b, u), whose memory it writes to, for these very spans.
  void record(std::span<const Vec<D>> b, std::span<Vec<D>> u, const StoppingRule&);
  /// `u`: first guess and solution.
  SolveReport solve();

  /// How it worked: libraries and loop.
  std::string libraries() const { return "cuSPARSE " + cusparse_.version() + ", " + blas_.name(); }
  const std::string& loop() const { return loop_.kind(); }

 private:
  using Flat = std::span<const double>;

  void start();
  void iterateCr();
  void iterateCg();
  void applyPreconditioner(Flat r, std::span<double> z);

  Context<Cuda>& context_;
  LibraryMethod method_;
  cusparseSpMVAlg_t algorithm_;
  CusparseHandle cusparse_;
  LibraryBlas blas_;
  LibraryProduct byA_;
  BucketLevels<Cuda> buckets_;
  LibraryMultigrid<D> multigrid_;
  Buffer<Block<D>, Cuda> diagonal_, blockInverse_;
  Buffer<Vec<D>, Cuda> inverse_;

  Flat b_;
  std::span<double> x_;
  Buffer<double, Cuda> r_, s_, p_, q_, y_;
  Buffer<LibraryCoefficients, Cuda> coefficients_;
  KrylovScalars* scalars_ = nullptr;
  StoppingRule rule_;
  LibraryLoop loop_;
};

}  // namespace treacle
