#include "treacle/linear/dense_inverse.hpp"

#include "linear/row_sums.cuh"

#include <algorithm>
#include <stdexcept>

namespace treacle {
namespace {

constexpr int panel = 32;  // unknowns that are eliminated at a time

template <class T>
struct Tasks {
  DenseTask<T> task[DenseInverses<T, Cuda>::most];
};

/// What the sweeps see of a matrix.
struct Dense {
  std::uint32_t panels, stride;
  double *dense, *b, *w;

  template <class T>
  __device__ explicit Dense(const DenseTask<T>& t)
      : panels(t.panels), stride(t.panels * panel), dense(t.dense), b(t.b), w(t.w) {}
};

/// One warp per block row: dense = A, lower triangle, in panels of 32. The dense matrix is zero before. No
/// atomics.
template <int B>
__global__ void fillKernel(BlockCsrView<B, double> a, std::uint32_t stride, double* dense) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
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

constexpr int pivotWarps = 8, pivotRows = panel / pivotWarps;  // of pivotKernel's blocks

/// A block: minus the inverse of a symmetric positive definite 32 x 32 matrix in 32 sweeps, thread (w, c) having
/// pivotRows rows of column c. `line` is the pivot's row, which is also its column, by turns in two places.
__device__ inline void sweepPanel(double (&mine)[pivotRows], double (&line)[2][panel]) {
  const int warp = threadIdx.x / panel, c = threadIdx.x % panel;
#pragma unroll 1
  for (int ofWarp = 0; ofWarp < pivotWarps; ++ofWarp)
#pragma unroll
    for (int s = 0; s < pivotRows; ++s) {
      const int p = ofWarp * pivotRows + s;
      double(&pivotRow)[panel] = line[s % 2];
      if (warp == ofWarp) pivotRow[c] = mine[s];
      __syncthreads();
      const double inverse = pivotRow[p] > 0 ? 1 / pivotRow[p] : 0;
      const double factor = c == p ? -inverse : pivotRow[c] * inverse;
#pragma unroll
      for (int t = 0; t < pivotRows; ++t) {
        const int r = warp * pivotRows + t;
        mine[t] = r == p ? factor : fma(-pivotRow[r], factor, c == p ? 0.0 : mine[t]);
      }
    }
}
static_assert(pivotRows % 2 == 0);

/// One block per matrix and panel of rows i, B_i being its columns of the pivot panel k: copies B_i, and writes
/// W_i = B_i (A_kk)^-1; every block inverts A_kk for itself. Block k leaves the swept A_kk, -(A_kk)^-1, as its W.
/// Reads the lower triangle; writes B and W. No atomics.
template <class T>
__global__ void __launch_bounds__(pivotWarps* panel)
    pivotKernel(std::uint32_t k, const __grid_constant__ Tasks<T> tasks) {
  const Dense m(tasks.task[blockIdx.y]);
  if (k >= m.panels || blockIdx.x >= m.panels) return;
  __shared__ double swept[panel][panel + 1], ofB[panel][panel + 1], line[2][panel];
  const int warp = threadIdx.x / panel, c = threadIdx.x % panel;
  const std::uint32_t i = blockIdx.x;
  const auto element = [&](std::uint32_t rowPanel, std::uint32_t columnPanel, int row, int column) {
    return m.dense[(std::size_t{rowPanel} * panel + row) * m.stride + columnPanel * panel + column];
  };
  for (int r = warp; r < panel; r += pivotWarps) {
    if (r >= c) swept[r][c] = swept[c][r] = element(k, k, r, c);
    if (i >= k)
      ofB[r][c] = element(i, k, r, c);
    else
      ofB[c][r] = element(k, i, r, c);  // its transpose lies in the lower triangle; read along rows
  }
  __syncthreads();
  double mine[pivotRows];
  for (int s = 0; s < pivotRows; ++s) mine[s] = swept[warp * pivotRows + s][c];
  sweepPanel(mine, line);
  for (int s = 0; s < pivotRows; ++s) swept[warp * pivotRows + s][c] = mine[s];
  __syncthreads();
  double sum[pivotRows] = {};
#pragma unroll 4
  for (int l = 0; l < panel; ++l)
    for (int s = 0; s < pivotRows; ++s) sum[s] -= ofB[warp * pivotRows + s][l] * swept[l][c];
  for (int s = 0; s < pivotRows; ++s) {
    const int r = warp * pivotRows + s;
    const std::size_t place = (std::size_t{i} * panel + r) * panel + c;
    m.b[place] = ofB[r][c];
    m.w[place] = i == k ? swept[r][c] : sum[s];
  }
}

/// One block of 32 x 32 threads per matrix and panel pair j <= i of the lower triangle: A_ij -= W_i B_j^T, in the
/// pivot's row and column of panels W instead. Reads and writes the lower triangle (of diagonal panels all); reads
/// B, W. No atomics.
template <class T>
__global__ void __launch_bounds__(panel* panel)
    eliminateKernel(std::uint32_t k, const __grid_constant__ Tasks<T> tasks) {
  const std::uint32_t i = blockIdx.y, j = blockIdx.x;
  const Dense m(tasks.task[blockIdx.z]);
  if (j > i || k >= m.panels || i >= m.panels) return;
  __shared__ double ofW[panel][panel + 1], ofB[panel][panel + 1];
  const int r = threadIdx.x / panel, c = threadIdx.x % panel;
  const auto load = [&](const double* from, std::uint32_t rowPanel) {
    return from[(std::size_t{rowPanel} * panel + r) * panel + c];
  };
  double& mine = m.dense[(std::size_t{i} * panel + r) * m.stride + j * panel + c];
  if (j == k) {
    mine = load(m.w, i);
    return;
  }
  ofW[r][c] = load(m.w, i == k ? j : i);
  ofB[r][c] = load(m.b, j);
  __syncthreads();
  if (i == k) {
    mine = ofW[c][r];
    return;
  }
  double sum = 0;
  for (int l = 0; l < panel; ++l) sum += ofW[r][l] * ofB[c][l];
  mine -= sum;
}

}  // namespace

template <class T>
template <int B>
void DenseInverses<T, Cuda>::add(Context<Cuda>& context, const BlockCsr<B, double, Cuda>& a,
                                 std::span<T> inverse) {
  const std::uint32_t n = B * a.rows(), panels = blocksFor(n, panel), stride = panels * panel;
  if (n == 0) return;
  if (tasks_.size() == most) throw std::length_error("more dense inverses at a time than DenseInverses::most");
  const auto room = [&](std::size_t size) { return memory_.emplace_back(context, size).data(); };
  const DenseTask<T> task{n,
                          panels,
                          room(std::size_t{stride} * stride),
                          room(std::size_t{stride} * panel),
                          room(std::size_t{stride} * panel),
                          inverse.data()};
  clearBytes(context, task.dense, std::size_t{stride} * stride * sizeof(double));
  launch(context, blocksFor(a.rows(), 4), 128, 0, fillKernel<B>, viewOf(a), stride, task.dense);
  launch(context, 1, 1024, 0, regulariseKernel<T>, n, stride, task.dense);
  tasks_.push_back(task);
}

/// Gauss-Jordan by symmetric sweeps: in the end dense = -A^-1.
template <class T>
void DenseInverses<T, Cuda>::finish(Context<Cuda>& context) {
  Tasks<T> tasks{};
  std::copy(tasks_.begin(), tasks_.end(), tasks.task);
  const auto count = static_cast<unsigned>(tasks_.size());
  std::uint32_t panels = 0;
  for (const DenseTask<T>& t : tasks_) panels = std::max(panels, t.panels);
  for (std::uint32_t k = 0; k < panels; ++k) {
    launch(context, dim3(panels, count), pivotWarps * panel, 0, pivotKernel<T>, k, tasks);
    launch(context, dim3(panels, panels, count), panel * panel, 0, eliminateKernel<T>, k, tasks);
  }
  for (const DenseTask<T>& t : tasks_)
    forEach(context, std::size_t{t.unknowns} * t.unknowns, [t] __device__(std::size_t e) {
      const std::size_t i = e / t.unknowns, j = e % t.unknowns, stride = std::size_t{t.panels} * panel;
      t.inverse[e] = static_cast<T>(-t.dense[i >= j ? i * stride + j : j * stride + i]);
    });
  tasks_.clear();
  memory_.clear();
}

#define TREACLE_INSTANTIATE(B)                                                                     \
  template void DenseInverses<double, Cuda>::add(Context<Cuda>&, const BlockCsr<B, double, Cuda>&, \
                                                 std::span<double>);                               \
  template void DenseInverses<float, Cuda>::add(Context<Cuda>&, const BlockCsr<B, double, Cuda>&,  \
                                                std::span<float>);
TREACLE_INSTANTIATE(1)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE
template void DenseInverses<double, Cuda>::finish(Context<Cuda>&);
template void DenseInverses<float, Cuda>::finish(Context<Cuda>&);

}  // namespace treacle
