#include "treacle/linear/dense_inverse.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace treacle {
namespace {

/// Lower triangle of A, regularised.
template <class T, int B>
std::vector<double> lowerTriangle(const BlockCsr<B>& a) {
  const std::size_t n = std::size_t{B} * a.rows();
  std::vector<double> m(n * n);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::uint64_t k = a.rowStart[i / B]; k < a.rowStart[i / B + 1]; ++k)
      for (std::size_t c = 0, j = std::size_t{B} * a.column[k]; c < B && j <= i; ++c, ++j)
        m[i * n + j] += a.value[k](static_cast<int>(i % B), static_cast<int>(c));
    largest = std::max(largest, m[i * n + i]);
  }
  for (std::size_t i = 0; i < n; ++i) m[i * n + i] += regularisation<T>(m[i * n + i], largest);
  return m;
}

/// Sweeps that are done together, so that the matrix is read once for all of them.
constexpr std::size_t panel = 8;

/// What the sweeps of one panel of columns do to all others: m_ij -= sum_b factor[b][i] column[b][j].
struct PanelSweep {
  std::size_t first, count;
  std::vector<double> columns, column, factor;  // panel vectors of n numbers each

  explicit PanelSweep(std::size_t n) : columns(panel * n), column(panel * n), factor(panel * n) {}

  /// Sweeps the panel's own columns by one after the other.
  void run(const std::vector<double>& m, std::size_t n, std::size_t begin, std::vector<bool>& hasPivot) {
    first = begin;
    count = std::min(panel, n - begin);
    for (std::size_t b = 0; b < count; ++b)
      for (std::size_t i = 0, k = first + b; i < n; ++i) columns[b * n + i] = i < k ? m[k * n + i] : m[i * n + k];
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t k = first + b;
      double *own = &columns[b * n], *c = &column[b * n], *f = &factor[b * n];
      const double pivot = own[k];
      hasPivot[k] = pivot > 0;
      const double inverse = hasPivot[k] ? 1 / pivot : 0;
      for (std::size_t i = 0; i < n; ++i) c[i] = own[i], f[i] = own[i] * inverse;
      c[k] = f[k] = 0;
      for (std::size_t other = 0; other < count; ++other) {
        double* to = &columns[other * n];
        const double there = c[first + other];
        if (other == b) continue;
        for (std::size_t i = 0; i < n; ++i) to[i] -= f[i] * there;
        to[k] = f[first + other];
      }
      for (std::size_t i = 0; i < n; ++i) own[i] = f[i];
      own[k] = -inverse;
    }
  }

  /// Row i of what the sweeps leave, up to the diagonal.
  void finishRow(std::vector<double>& m, std::size_t n, std::size_t i) const {
    double* row = &m[i * n];
    if (i >= first && i < first + count) {
      for (std::size_t j = 0; j <= i; ++j) row[j] = columns[(i - first) * n + j];
      return;
    }
    double f[panel] = {};
    const double* c[panel];
    for (std::size_t b = 0; b < panel; ++b) c[b] = &column[b * n];
    for (std::size_t b = 0; b < count; ++b) f[b] = factor[b * n + i];
    for (std::size_t j = 0; j <= i; ++j)
      row[j] -= f[0] * c[0][j] + f[1] * c[1][j] + f[2] * c[2][j] + f[3] * c[3][j] + f[4] * c[4][j] +
                f[5] * c[5][j] + f[6] * c[6][j] + f[7] * c[7][j];
    for (std::size_t b = 0; b < count && first + b < i; ++b) row[first + b] = columns[b * n + i];
  }
};

/// -A^-1 in place of A, a lower triangle, by symmetric sweeps: of pivot k, a_ij -= a_ik a_jk / a_kk, a_ik /= a_kk,
/// a_kk = -1 / a_kk. Rows and columns without a positive pivot become zero.
void invert(std::vector<double>& m, std::size_t n) {
  PanelSweep sweep(n);
  std::vector<bool> hasPivot(n);
  for (std::size_t begin = 0; begin < n; begin += panel) {
    sweep.run(m, n, begin, hasPivot);
    parallelFor((n + 1) / 2, 16, [&](std::size_t pair) {  // a short row with a long one
      sweep.finishRow(m, n, pair);
      if (n - 1 - pair > pair) sweep.finishRow(m, n, n - 1 - pair);
    });
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (!hasPivot[i] || !hasPivot[j]) m[i * n + j] = 0;
}

}  // namespace

template <class T>
template <int B>
void DenseInverses<T, Cpu>::add(Context<Cpu>&, const BlockCsr<B>& a, std::span<T> inverse) {
  const std::size_t n = std::size_t{B} * a.rows();
  std::vector<double> m = lowerTriangle<T>(a);
  invert(m, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) inverse[i * n + j] = inverse[j * n + i] = static_cast<T>(-m[i * n + j]);
}

#define TREACLE_INSTANTIATE(B)                                                                         \
  template void DenseInverses<double, Cpu>::add(Context<Cpu>&, const BlockCsr<B>&, std::span<double>); \
  template void DenseInverses<float, Cpu>::add(Context<Cpu>&, const BlockCsr<B>&, std::span<float>);
TREACLE_INSTANTIATE(1)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
