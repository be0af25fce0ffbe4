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

/// A = L L^T in place, L_ii replaced by its inverse.
void factorise(std::vector<double>& m, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    double pivot = m[j * n + j];
    for (std::size_t k = 0; k < j; ++k) pivot -= m[j * n + k] * m[j * n + k];
    const double inverse = pivot > 0 ? 1 / std::sqrt(pivot) : 0;
    m[j * n + j] = inverse;
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      m[i * n + j] = sum * inverse;
    }
  }
}

/// L^-1 in place of L, by columns.
void invertTriangle(std::vector<double>& m, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum += m[i * n + k] * m[k * n + j];
      m[i * n + j] = -sum * m[i * n + i];
    }
}

}  // namespace

template <class T>
template <int B>
void DenseInverses<T, Cpu>::add(Context<Cpu>&, const BlockCsr<B>& a, std::span<T> inverse) {
  const std::size_t n = std::size_t{B} * a.rows();
  std::vector<double> m = lowerTriangle<T>(a);
  factorise(m, n);
  invertTriangle(m, n);
  parallelFor(n, 64, [&](std::size_t i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (std::size_t k = i; k < n; ++k) sum += m[k * n + i] * m[k * n + j];
      inverse[i * n + j] = inverse[j * n + i] = static_cast<T>(sum);
    }
  });
}

#define TREACLE_INSTANTIATE(B)                                                                         \
  template void DenseInverses<double, Cpu>::add(Context<Cpu>&, const BlockCsr<B>&, std::span<double>); \
  template void DenseInverses<float, Cpu>::add(Context<Cpu>&, const BlockCsr<B>&, std::span<float>);
TREACLE_INSTANTIATE(1)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
