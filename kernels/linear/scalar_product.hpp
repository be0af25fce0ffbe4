#pragma once

#include "linear/cusparse.hpp"
#include "treacle/core/cuda.hpp"

#include <cstdint>

namespace treacle {

/// Sparse matrix of numbers in compressed rows, as cuSPARSE's products take it.
struct ScalarCsr {
  std::int64_t rows = 0, columns = 0;
  Buffer<std::int32_t, Cuda> start;  // rows + 1
  Buffer<std::int32_t, Cuda> column;
  Buffer<double, Cuda> value;

  void resize(const Context<Cuda>& context, std::int64_t rowCount, std::int64_t columnCount) {
    rows = rowCount;
    columns = columnCount;
    start.resize(context, static_cast<std::size_t>(rows) + 1);
  }
  void reserveEntries(const Context<Cuda>& context, std::int64_t count) {
    column.resize(context, static_cast<std::size_t>(count));
    value.resize(context, static_cast<std::size_t>(count));
  }
  std::size_t bytes() const { return start.bytes() + column.bytes() + value.bytes(); }
};

/// Products of such matrices; keeps its workspace, and the algorithm that the last product got through with.
class ScalarProduct {
 public:
  ScalarProduct() { TREACLE_CUSPARSE_CHECK(cusparse().Create(&handle_)); }
  ScalarProduct(const ScalarProduct&) = delete;
  ~ScalarProduct() { cusparse().Destroy(handle_); }

  /// t = a^T, columns ascending. `a` must have entries.
  void transpose(Context<Cuda>&, const ScalarCsr& a, ScalarCsr& t);
  /// c = a b. Columns of c ascend within a row. Errors: RunError when no algorithm has the resources.
  void compute(Context<Cuda>&, const ScalarCsr& a, const ScalarCsr& b, ScalarCsr& c);
  std::size_t bytes() const { return estimate_.bytes() + memory_.bytes() + work_.bytes(); }

 private:
  bool attempt(Context<Cuda>&, const ScalarCsr& a, const ScalarCsr& b, ScalarCsr& c,
               cusparseSpGEMMAlg_t algorithm);

  cusparseHandle_t handle_ = nullptr;
  int algorithm_ = 0;
  Buffer<std::byte, Cuda> estimate_, memory_, work_;
};

}  // namespace treacle
