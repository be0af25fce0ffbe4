#include "library_csr.hpp"

#include "core/launch.hpp"
#include "treacle/core/error.hpp"
#include "treacle/linear/bucket_cycle.hpp"

#include <limits>
#include <string>

namespace treacle {
namespace {

constexpr int warpsPerBlock = 8;

/// One warp per row of blocks; reads its blocks; writes its D rows of numbers. No atomics.
template <int D>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    splitBlocksKernel(std::uint32_t rows, const std::uint64_t* rowStart, const std::uint32_t* blockColumn,
                      const Block<D>* block, std::int32_t* start, std::int32_t* column, double* value) {
  const std::uint32_t row = blockIdx.x * warpsPerBlock + threadIdx.x / 32, lane = threadIdx.x % 32;
  if (row >= rows) return;
  const std::uint64_t begin = rowStart[row], blocks = rowStart[row + 1] - begin;
  for (int r = 0; r < D; ++r) {
    const std::uint64_t first = begin * (D * D) + r * blocks * D;
    if (lane == 0) start[std::size_t{row} * D + r] = static_cast<std::int32_t>(first);
    for (std::uint64_t k = lane; k < blocks; k += 32)
      for (int c = 0; c < D; ++c) {
        column[first + k * D + c] = static_cast<std::int32_t>(blockColumn[begin + k] * D + c);
        value[first + k * D + c] = block[begin + k](r, c);
      }
  }
  if (row + 1 == rows && lane == 0)
    start[std::size_t{rows} * D] = static_cast<std::int32_t>((begin + blocks) * D * D);
}

class Vector {
 public:
  explicit Vector(std::span<double> v) {
    TREACLE_CUSPARSE_CHECK(
        cusparseCreateDnVec(&descriptor_, static_cast<std::int64_t>(v.size()), v.data(), CUDA_R_64F));
  }
  Vector(const Vector&) = delete;
  ~Vector() { cusparseDestroyDnVec(descriptor_); }
  operator cusparseDnVecDescr_t() const { return descriptor_; }

 private:
  cusparseDnVecDescr_t descriptor_ = nullptr;
};

class ConstVector {
 public:
  explicit ConstVector(std::span<const double> v) {
    TREACLE_CUSPARSE_CHECK(
        cusparseCreateConstDnVec(&descriptor_, static_cast<std::int64_t>(v.size()), v.data(), CUDA_R_64F));
  }
  ConstVector(const ConstVector&) = delete;
  ~ConstVector() { cusparseDestroyDnVec(descriptor_); }
  operator cusparseConstDnVecDescr_t() const { return descriptor_; }

 private:
  cusparseConstDnVecDescr_t descriptor_ = nullptr;
};

}  // namespace

std::string CusparseHandle::version() const {
  int number = 0;
  TREACLE_CUSPARSE_CHECK(cusparseGetVersion(handle_, &number));
  return std::to_string(number / 1000) + "." + std::to_string(number / 100 % 10) + "." +
         std::to_string(number % 100);
}

template <int D>
void scalarMatrix(const Context<Cuda>& context, const BlockCsr<D, double, Cuda>& from, ScalarCsr& to) {
  const std::uint64_t entries = from.value.size() * (D * D);
  if (entries > std::numeric_limits<std::int32_t>::max())
    throw RunError("the matrix has " + std::to_string(entries) +
                   " nonzeros, more than cuSPARSE's 32-bit rows count");
  const std::int64_t n = std::int64_t{D} * from.rows();
  to.resize(context, n, n);
  to.reserveEntries(context, static_cast<std::int64_t>(entries));
  launch(context, blocksFor(from.rows(), warpsPerBlock), 32 * warpsPerBlock, 0, splitBlocksKernel<D>, from.rows(),
         from.rowStart.data(), from.column.data(), from.value.data(), to.start.data(), to.column.data(),
         to.value.data());
}

template <int D>
void transferMatrices(Context<Cuda>& context, std::span<const std::uint32_t> members, std::uint32_t fineRows,
                      ScalarCsr& restriction, ScalarCsr& prolongation) {
  const std::size_t n = std::size_t{D} * fineRows, coarse = D * (members.size() - 1);
  const auto rows = static_cast<std::int64_t>(n), coarseRows = static_cast<std::int64_t>(coarse);
  restriction.resize(context, coarseRows, rows);
  prolongation.resize(context, rows, coarseRows);
  for (ScalarCsr* m : {&restriction, &prolongation}) m->reserveEntries(context, rows);
  Buffer<std::uint32_t, Cuda> parentOf(context, fineRows);
  findParents(context, members, parentOf.span());
  const std::uint32_t *parent = parentOf.data(), *first = members.data();

  forEach(context, n + 1,
          [=, start = prolongation.start.data(), column = prolongation.column.data(),
           ones = prolongation.value.data()] __device__(std::size_t e) {
            start[e] = static_cast<std::int32_t>(e);
            if (e == n) return;
            column[e] = static_cast<std::int32_t>(D * parent[e / D] + e % D);
            ones[e] = 1;
          });
  // A coarse row's components stand behind each other, each with one entry per member.
  forEach(context, n,
          [=, column = restriction.column.data(), ones = restriction.value.data()] __device__(std::size_t e) {
            const auto i = static_cast<std::uint32_t>(e / D), c = static_cast<std::uint32_t>(e % D);
            const std::uint32_t begin = first[parent[i]], count = first[parent[i] + 1] - begin;
            const std::uint32_t place = D * begin + c * count + (i - begin);
            column[place] = static_cast<std::int32_t>(e);
            ones[place] = 1;
          });
  forEach(context, coarse + 1, [=, start = restriction.start.data()] __device__(std::size_t e) {
    const std::uint32_t begin = first[e / D], count = e == coarse ? 0 : first[e / D + 1] - begin;
    start[e] = static_cast<std::int32_t>(D * begin + e % D * count);
  });
}

void leaveOut(const Context<Cuda>& context, std::span<const double> inverse, ScalarCsr& restriction,
              ScalarCsr& prolongation) {
  // One entry per fine row in both.
  forEach(context, inverse.size(),
          [inverse = inverse.data(), down = restriction.value.data(), row = restriction.column.data(),
           up = prolongation.value.data()] __device__(std::size_t e) {
            up[e] = inverse[e] == 0 ? 0 : 1;
            down[e] = inverse[row[e]] == 0 ? 0 : 1;
          });
}

void extendedJacobi(const Context<Cuda>& context, const ScalarCsr& a, Buffer<double, Cuda>& inverse) {
  inverse.resize(context, static_cast<std::size_t>(a.rows));
  forEach(context, inverse.size(),
          [to = inverse.data(), start = a.start.data(), value = a.value.data()] __device__(std::size_t row) {
            double sum = 0;
            for (std::int32_t k = start[row]; k < start[row + 1]; ++k) sum += fabs(value[k]);
            to[row] = sum > 0 ? 2 / sum : 0;
          });
}

LibraryProduct::~LibraryProduct() {
  if (matrix_) cusparseDestroySpMat(matrix_);
}

void LibraryProduct::prepare(Context<Cuda>& context, cusparseHandle_t handle, const ScalarCsr& a,
                             cusparseSpMVAlg_t algorithm) {
  if (matrix_) TREACLE_CUSPARSE_CHECK(cusparseDestroySpMat(std::exchange(matrix_, nullptr)));
  handle_ = handle;
  algorithm_ = algorithm;
  const auto entries = static_cast<std::int64_t>(a.column.size());
  TREACLE_CUSPARSE_CHECK(
      cusparseCreateCsr(&matrix_, a.rows, a.columns, entries, const_cast<std::int32_t*>(a.start.data()),
                        const_cast<std::int32_t*>(a.column.data()), const_cast<double*>(a.value.data()),
                        CUSPARSE_INDEX_32I, CUSPARSE_INDEX_32I, CUSPARSE_INDEX_BASE_ZERO, CUDA_R_64F));

  // The analysis looks at the rows, not at these vectors; it spares every later product its own.
  Buffer<double, Cuda> x(context, static_cast<std::size_t>(a.columns)),
      y(context, static_cast<std::size_t>(a.rows));
  clearBytes(context, x.data(), x.bytes());
  clearBytes(context, y.data(), y.bytes());
  const ConstVector from(x.span());
  const Vector to(y.span());
  const double one = 1, zero = 0;
  std::size_t bytes = 0;
  constexpr auto as = CUSPARSE_OPERATION_NON_TRANSPOSE;
  TREACLE_CUSPARSE_CHECK(
      cusparseSpMV_bufferSize(handle, as, &one, matrix_, from, &zero, to, CUDA_R_64F, algorithm, &bytes));
  buffer_.resize(context, std::max(bytes, std::size_t{256}));
  TREACLE_CUSPARSE_CHECK(
      cusparseSpMV_preprocess(handle, as, &one, matrix_, from, &zero, to, CUDA_R_64F, algorithm, buffer_.data()));
}

void LibraryProduct::multiply(double alpha, std::span<const double> x, double beta, std::span<double> y) const {
  const ConstVector from(x);
  const Vector to(y);
  TREACLE_CUSPARSE_CHECK(cusparseSpMV(handle_, CUSPARSE_OPERATION_NON_TRANSPOSE, &alpha, matrix_, from, &beta, to,
                                      CUDA_R_64F, algorithm_, const_cast<std::byte*>(buffer_.data())));
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void scalarMatrix<D>(const Context<Cuda>&, const BlockCsr<D, double, Cuda>&, ScalarCsr&);           \
  template void transferMatrices<D>(Context<Cuda>&, std::span<const std::uint32_t>, std::uint32_t, ScalarCsr&, \
                                    ScalarCsr&);
TREACLE_INSTANTIATE(1)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
