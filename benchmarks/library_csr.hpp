#pragma once

#include "linear/scalar_product.hpp"
#include "treacle/linear/block_csr.hpp"

#include <span>
#include <string>

namespace treacle {

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

/// A matrix of blocks as one of numbers; columns within a row keep their order. Errors: RunError for more nonzeros
/// than 32 bits count: cuSPARSE has no products with 64-bit rows and 32-bit columns.
template <int D>
void scalarMatrix(const Context<Cuda>&, const BlockCsr<D, double, Cuda>& from, ScalarCsr& to);

/// The summation over members, R, and P = R^T, for vectors of D components. `members`: first fine row of each
/// coarse one, and the end; device memory.
template <int D>
void transferMatrices(Context<Cuda>&, std::span<const std::uint32_t> members, std::uint32_t fineRows,
                      ScalarCsr& restriction, ScalarCsr& prolongation);

/// Weight zero for those rows of transfers between numbers (D = 1) for which `inverse` is zero.
void leaveOut(const Context<Cuda>&, std::span<const double> inverse, ScalarCsr& restriction,
              ScalarCsr& prolongation);

/// 2 / sum_j |A_ij| [K23 eq. (41)], or zero for a row of zeros.
void extendedJacobi(const Context<Cuda>&, const ScalarCsr& a, Buffer<double, Cuda>& inverse);

/// y = alpha A x + beta y by cusparseSpMV. The matrix must outlive this.
class LibraryProduct {
 public:
  LibraryProduct() = default;
  LibraryProduct(const LibraryProduct&) = delete;
  ~LibraryProduct();

  void prepare(Context<Cuda>&, cusparseHandle_t, const ScalarCsr& a, cusparseSpMVAlg_t);
  void multiply(double alpha, std::span<const double> x, double beta, std::span<double> y) const;

 private:
  cusparseHandle_t handle_ = nullptr;
  cusparseSpMatDescr_t matrix_ = nullptr;
  cusparseSpMVAlg_t algorithm_ = CUSPARSE_SPMV_ALG_DEFAULT;
  Buffer<std::byte, Cuda> buffer_;
};

}  // namespace treacle
