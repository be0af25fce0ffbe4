#pragma once

#include "library_blas.hpp"
#include "library_csr.hpp"
#include "library_loop.hpp"
#include "treacle/model/case/case.hpp"

#include <functional>
#include <span>
#include <string>

namespace treacle {

/// The scalars that cuBLAS reads and writes, in device memory.
struct LibraryCoefficients {
  double sum, sumOfB;
  double alpha, minusAlpha, beta, one;
};

/// Preconditioned conjugate gradients, or conjugate residuals [K23 eqs. (21)-(32)], of plain cuSPARSE and cuBLAS
/// calls in double precision, a graph of them per iteration.
class LibraryKrylov {
 public:
  using Flat = std::span<const double>;
  /// z = K r
  using Preconditioner = std::function<void(Flat r, std::span<double> z)>;

  LibraryKrylov(Context<Cuda>& context, KrylovKind kind)
      : context_(context), kind_(kind), cusparse_(context), blas_(context) {}

  /// Prepares solve(), which starts from x and writes the solution there, for these very spans. `k`: empty without
  /// a preconditioner.
  void record(const LibraryProduct& a, Preconditioner k, Flat b, std::span<double> x, const StoppingRule&);
  SolveReport solve();

  const CusparseHandle& cusparse() const { return cusparse_; }
  /// How it worked: libraries and loop.
  std::string libraries() const { return "cuSPARSE " + cusparse_.version() + ", " + blas_.name(); }
  const std::string& loop() const { return loop_.kind(); }

 private:
  void start();
  void iterateCr();
  void iterateCg();

  Context<Cuda>& context_;
  KrylovKind kind_;
  CusparseHandle cusparse_;
  LibraryBlas blas_;
  const LibraryProduct* a_ = nullptr;
  Preconditioner k_;
  Flat b_;
  std::span<double> x_;
  Buffer<double, Cuda> r_, s_, p_, q_, y_;
  Buffer<LibraryCoefficients, Cuda> coefficients_;
  KrylovScalars* scalars_ = nullptr;
  StoppingRule rule_;
  LibraryLoop loop_;
};

}  // namespace treacle
