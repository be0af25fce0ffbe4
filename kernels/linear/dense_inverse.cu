#include "treacle/linear/dense_inverse.hpp"

#include "linear/row_sums.cuh"

namespace treacle {
namespace {

constexpr int panel = 32;  // unknowns that are eliminated at a time

/// One warp per block row: dense = A, lower triangle, in panels of 32. The dense matrix is zero before. No
/// atomics.
template <int B>
__global__ void fillKernel(BlockCsrView<B, double> a, std::uint32_t stride, double* dense) {
  const std::uint32_t row = (blockIdx.x * blockDim.x + threadIdx.x) / 32;
  if (row >= a.rows) return;
  constexpr unsigned elements = B * B;
  const std::uint64_t begin = a.rowStart[row];
  const double* value = a.value[begin].a;
  const auto numbers = static_cast<std::uint32_t>(a.rowStart[row + 1] - begin) * elements;
  for (std::uint32_t k = threadIdx.x % 32; k < numbers; k += 32) {
    const std::uint32_t i = row * B + k % elements / B, j = a.column[begin + k / elements] * B + k % B;
    if (j <= i) dense[std::size_t{i} * stride + j] = value[k];
  }
}

/// One block: regularises the diagonal and gives the unknowns that fill the last panel a diagonal of 1. No
/// atomics.
template <class T>
__global__ void __launch_bounds__(1024) regulariseKernel(std::uint32_t rows, std::uint32_t stride, double* dense) {
  __shared__ double ofWarp[32];
  double largest = 0;
  for (std::size_t i = threadIdx.x; i < rows; i += 1024) largest = fmax(largest, dense[i * stride + i]);
  for (int offset = 16; offset > 0; offset /= 2) largest = fmax(largest, __shfl_xor_sync(~0u, largest, offset));
  if (threadIdx.x % 32 == 0) ofWarp[threadIdx.x / 32] = largest;
  __syncthreads();
  for (double w : ofWarp) largest = fmax(largest, w);
  for (std::size_t i = threadIdx.x; i < stride; i += 1024) {
    double& diagonal = dense[i * stride + i];
    diagonal = i < rows ? diagonal + regularisation<T>(diagonal, largest) : 1;
  }
}

/// Element (r, c) of minus the inverse of a symmetric positive definite 32 x 32 matrix, one thread each, `mine`
/// its element: 32 sweeps. `line` keeps the pivot's row, which is also its column, by turns in two places.
__device__ double sweepPanel(double mine, int r, int c, double (*line)[panel]) {
  for (int p = 0; p < panel; ++p) {
    double* pivotRow = line[p % 2];
    if (r == p) pivotRow[c] = mine;
    __syncthreads();
    const double pivot = pivotRow[p], inverse = pivot > 0 ? 1 / pivot : 0;
    if (r == p && c == p)
      mine = -inverse;
    else if (r == p || c == p)
      mine = pivotRow[r == p ? c : r] * inverse;
    else
      mine -= pivotRow[r] * pivotRow[c] * inverse;
  }
  return mine;
}

/// One block of 32 x 32 threads per panel of rows i, B_i being its columns of the pivot panel k: copies B_i, and
/// writes W_i = B_i (A_kk)^-1; every block inverts A_kk for itself. Block k leaves the swept A_kk, -(A_kk)^-1, as
/// its W. Reads the lower triangle; writes B and W. No atomics.
__global__ void __launch_bounds__(panel* panel)
    pivotKernel(std::uint32_t k, std::uint32_t stride, const double* dense, double* b, double* w) {
  __shared__ double inverse[panel][panel + 1], ofB[panel][panel + 1], line[2][panel];
  const int r = threadIdx.x / panel, c = threadIdx.x % panel;
  const std::uint32_t i = blockIdx.x;
  const auto element = [&](std::uint32_t rowPanel, std::uint32_t columnPanel, int row, int column) {
    return dense[(std::size_t{rowPanel} * panel + row) * stride + columnPanel * panel + column];
  };
  const double pivotElement = r >= c ? element(k, k, r, c) : element(k, k, c, r);
  if (i >= k)
    ofB[r][c] = element(i, k, r, c);
  else
    ofB[c][r] = element(k, i, r, c);  // its transpose lies in the lower triangle; read along rows
  const double swept = sweepPanel(pivotElement, r, c, line);
  inverse[r][c] = -swept;
  __syncthreads();
  double sum = 0;
  for (int m = 0; m < panel; ++m) sum += ofB[r][m] * inverse[m][c];
  const std::size_t place = (std::size_t{i} * panel + r) * panel + c;
  b[place] = ofB[r][c];
  w[place] = i == k ? swept : sum;
}

/// One block of 32 x 32 threads per panel pair j <= i of the lower triangle: A_ij -= W_i B_j^T, in the pivot's row
/// and column of panels W instead. Reads and writes the lower triangle (of diagonal panels all); reads B, W. No
/// atomics.
__global__ void __launch_bounds__(panel* panel)
    eliminateKernel(std::uint32_t k, std::uint32_t stride, const double* b, const double* w, double* dense) {
  const std::uint32_t i = blockIdx.y, j = blockIdx.x;
  if (j > i) return;
  __shared__ double ofW[panel][panel + 1], ofB[panel][panel + 1];
  const int r = threadIdx.x / panel, c = threadIdx.x % panel;
  const auto load = [&](const double* from, std::uint32_t rowPanel) {
    return from[(std::size_t{rowPanel} * panel + r) * panel + c];
  };
  double& mine = dense[(std::size_t{i} * panel + r) * stride + j * panel + c];
  if (j == k) {
    mine = load(w, i);
    return;
  }
  ofW[r][c] = load(w, i == k ? j : i);
  ofB[r][c] = load(b, j);
  __syncthreads();
  if (i == k) {
    mine = ofW[c][r];
    return;
  }
  double sum = 0;
  for (int m = 0; m < panel; ++m) sum += ofW[r][m] * ofB[c][m];
  mine -= sum;
}

}  // namespace

template <class T, int B>
void denseInverse(Context<Cuda>& context, const BlockCsr<B, double, Cuda>& a, std::span<T> inverse) {
  const std::uint32_t n = B * a.rows(), panels = blocksFor(n, panel), stride = panels * panel;
  if (n == 0) return;
  Buffer<double, Cuda> dense(context, std::size_t{stride} * stride), b(context, std::size_t{stride} * panel),
      w(context, std::size_t{stride} * panel);
  clearBytes(context, dense.data(), std::size_t{stride} * stride * sizeof(double));
  launch(context, blocksFor(a.rows(), 4), 128, 0, fillKernel<B>, viewOf(a), stride, dense.data());
  launch(context, 1, 1024, 0, regulariseKernel<T>, n, stride, dense.data());
  // Gauss-Jordan by symmetric sweeps: in the end dense = -A^-1.
  for (std::uint32_t k = 0; k < panels; ++k) {
    launch(context, panels, panel * panel, 0, pivotKernel, k, stride, dense.data(), b.data(), w.data());
    launch(context, dim3(panels, panels), panel * panel, 0, eliminateKernel, k, stride, b.data(), w.data(),
           dense.data());
  }
  forEach(context, std::size_t{n} * n,
          [n, stride, from = dense.data(), to = inverse.data()] __device__(std::size_t e) {
            const std::size_t i = e / n, j = e % n;
            to[e] = static_cast<T>(-from[i >= j ? i * stride + j : j * stride + i]);
          });
}

#define TREACLE_INSTANTIATE(B)                                                                                \
  template void denseInverse<double, B>(Context<Cuda>&, const BlockCsr<B, double, Cuda>&, std::span<double>); \
  template void denseInverse<float, B>(Context<Cuda>&, const BlockCsr<B, double, Cuda>&, std::span<float>);
TREACLE_INSTANTIATE(1)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
