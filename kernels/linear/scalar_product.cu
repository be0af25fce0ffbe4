#include "linear/scalar_product.hpp"

#include "core/cuda_check.hpp"
#include "treacle/core/error.hpp"

#include <algorithm>
#include <new>

namespace treacle {
namespace {

/// Each needs less memory, and more time, than the one before.
constexpr cusparseSpGEMMAlg_t algorithms[] = {CUSPARSE_SPGEMM_DEFAULT, CUSPARSE_SPGEMM_ALG2, CUSPARSE_SPGEMM_ALG3};
constexpr int algorithmCount = 3;

/// Share of the products that ALG3 has in memory at a time.
constexpr float chunkFraction = 0.1f;

class Descriptor {
 public:
  Descriptor(const ScalarCsr& m, std::int32_t* column, double* value) {
    TREACLE_CUSPARSE_CHECK(
        cusparse().CreateCsr(&matrix_, m.rows, m.columns, column ? static_cast<std::int64_t>(m.column.size()) : 0,
                             const_cast<std::int32_t*>(m.start.data()), column, value, CUSPARSE_INDEX_32I,
                             CUSPARSE_INDEX_32I, CUSPARSE_INDEX_BASE_ZERO, CUDA_R_64F));
  }
  /// A matrix that is read. The constness is given back by what the products take.
  explicit Descriptor(const ScalarCsr& m)
      : Descriptor(m, const_cast<std::int32_t*>(m.column.data()), const_cast<double*>(m.value.data())) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() { cusparse().DestroySpMat(matrix_); }
  operator cusparseSpMatDescr_t() const { return matrix_; }

 private:
  cusparseSpMatDescr_t matrix_ = nullptr;
};

/// The state of one product between cuSPARSE's calls.
class State {
 public:
  State() { TREACLE_CUSPARSE_CHECK(cusparse().SpGEMM_createDescr(&state_)); }
  State(const State&) = delete;
  ~State() { cusparse().SpGEMM_destroyDescr(state_); }
  operator cusparseSpGEMMDescr_t() const { return state_; }

 private:
  cusparseSpGEMMDescr_t state_ = nullptr;
};

/// Whether a call went well; false when it lacked resources.
bool hadResources(cusparseStatus_t status, const char* file, int line) {
  if (status == CUSPARSE_STATUS_INSUFFICIENT_RESOURCES || status == CUSPARSE_STATUS_ALLOC_FAILED) {
    cudaGetLastError();  // must not meet the next call
    return false;
  }
  cusparseCheck(status, file, line);
  return true;
}
#define TREACLE_HAD_RESOURCES(call) hadResources((call), __FILE__, __LINE__)

/// cuSPARSE takes a null pointer for a question about the size.
void* workspace(const Context<Cuda>& context, Buffer<std::byte, Cuda>& buffer, std::size_t bytes) {
  buffer.resize(context, std::max(bytes, std::size_t{256}));
  return buffer.data();
}

}  // namespace

bool ScalarProduct::attempt(Context<Cuda>& context, const ScalarCsr& a, const ScalarCsr& b, ScalarCsr& c,
                            cusparseSpGEMMAlg_t algorithm) {
  c.resize(context, a.rows, b.columns);
  const Descriptor ma(a), mb(b), mc(c, nullptr, nullptr);
  const State state;
  const double one = 1, zero = 0;
  constexpr auto as = CUSPARSE_OPERATION_NON_TRANSPOSE;
  const auto call = [&](auto function, auto... rest) {
    return function(handle_, as, as, &one, ma, mb, &zero, mc, CUDA_R_64F, algorithm, state, rest...);
  };

  std::size_t bytes = 0;
  void* none = nullptr;
  if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_workEstimation, &bytes, none))) return false;
  void* estimate = workspace(context, estimate_, bytes);
  if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_workEstimation, &bytes, estimate))) return false;

  std::size_t workBytes = 0;
  if (algorithm == CUSPARSE_SPGEMM_DEFAULT) {
    if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_compute, &workBytes, none))) return false;
  } else {
    std::size_t* unasked = nullptr;
    if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_estimateMemory, chunkFraction, &bytes, none, unasked)))
      return false;
    void* memory = workspace(context, memory_, bytes);
    if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_estimateMemory, chunkFraction, &bytes, memory, &workBytes)))
      return false;
  }
  void* work = workspace(context, work_, workBytes);
  if (!TREACLE_HAD_RESOURCES(call(cusparse().SpGEMM_compute, &workBytes, work))) return false;

  std::int64_t rows = 0, columns = 0, entries = 0;
  TREACLE_CUSPARSE_CHECK(cusparse().SpMatGetSize(mc, &rows, &columns, &entries));
  c.reserveEntries(context, entries);
  TREACLE_CUSPARSE_CHECK(cusparse().CsrSetPointers(mc, c.start.data(), c.column.data(), c.value.data()));
  TREACLE_CUSPARSE_CHECK(call(cusparse().SpGEMM_copy));
  return true;
}

void ScalarProduct::transpose(Context<Cuda>& context, const ScalarCsr& a, ScalarCsr& t) {
  const std::size_t entries = a.column.size();
  t.resize(context, a.columns, a.rows);
  t.reserveEntries(context, static_cast<std::int64_t>(entries));
  const auto call = [&](auto function, auto rest) {
    return function(handle_, static_cast<int>(a.rows), static_cast<int>(a.columns), static_cast<int>(entries),
                    a.value.data(), a.start.data(), a.column.data(), t.value.data(), t.start.data(),
                    t.column.data(), CUDA_R_64F, CUSPARSE_ACTION_NUMERIC, CUSPARSE_INDEX_BASE_ZERO,
                    CUSPARSE_CSR2CSC_ALG1, rest);
  };
  TREACLE_CUSPARSE_CHECK(cusparse().SetStream(handle_, context.stream()));
  std::size_t bytes = 0;
  TREACLE_CUSPARSE_CHECK(call(cusparse().Csr2cscEx2_bufferSize, &bytes));
  TREACLE_CUSPARSE_CHECK(call(cusparse().Csr2cscEx2, workspace(context, work_, bytes)));
}

void ScalarProduct::compute(Context<Cuda>& context, const ScalarCsr& a, const ScalarCsr& b, ScalarCsr& c) {
  TREACLE_CUSPARSE_CHECK(cusparse().SetStream(handle_, context.stream()));
  for (; algorithm_ < algorithmCount; ++algorithm_) {
    try {
      if (attempt(context, a, b, c, algorithms[algorithm_])) return;
    } catch (const std::bad_alloc&) {
      if (algorithm_ + 1 == algorithmCount) throw;
    }
    // What the attempt took must be there for the next one.
    for (Buffer<std::byte, Cuda>* buffer : {&estimate_, &memory_, &work_}) *buffer = {};
  }
  algorithm_ = 0;
  throw RunError(
      "cuSPARSE has too few resources for the matrix products that give the coarse operators; the route 'direct' "
      "needs no such products");
}

}  // namespace treacle
