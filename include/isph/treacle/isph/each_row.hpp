#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/isph/isph_matrix.hpp"

namespace treacle {

// Products of isph_matrix.hpp for the sources of both backends, which instantiate them. Each has, beside forEach,
//
//   forEachSum<Staged>(context, a, x, store): store(row, sum of its coefficients times x), x being brought
//     together as numbers of the type Staged on a device

template <class Staged, class T, class Backend>
void multiplyStaged(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> x,
                    std::span<double> y) {
  const double* const diagonal = a.diagonal;
  forEachSum<Staged>(context, a, x.data(),
                     [=] TREACLE_HD(std::uint32_t i, double sum) { y[i] = diagonal[i] * x[i] - sum; });
}

template <class T, class Backend>
void multiply(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y) {
  multiplyStaged<double>(context, a, x, y);
}

template <class T, class Backend>
void multiplySingle(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> x,
                    std::span<double> y) {
  multiplyStaged<float>(context, a, x, y);
}

template <class T, class Backend>
void firstSweep(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> r, std::span<T> x) {
  const T* const inverse = a.inverseNear;
  forEach(context, a.rows, [=] TREACLE_HD(std::size_t i) { x[i] = inverse[i] * static_cast<T>(r[i]); });
}

template <class T, class Backend>
void jacobi(Context<Backend>& context, const IsphMatrix<T>& a, std::span<const double> r, std::span<double> z) {
  const double* const diagonal = a.diagonal;
  forEach(context, a.rows, [=] TREACLE_HD(std::size_t i) { z[i] = diagonal[i] > 0 ? r[i] / diagonal[i] : 0; });
}

#define TREACLE_EACH_ROW(T, Backend)                                                                            \
  template void multiply(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>, std::span<double>);  \
  template void multiplySingle(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>,                \
                               std::span<double>);                                                              \
  template void firstSweep(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>, std::span<T>);     \
  template void nearResidual(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>,                  \
                             std::span<const T>, std::span<T>);                                                 \
  template void lastSweep(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>, std::span<const T>, \
                          std::span<double>);                                                                   \
  template void jacobi(Context<Backend>&, const IsphMatrix<T>&, std::span<const double>, std::span<double>);    \
  template void compressed(Context<Backend>&, const IsphMatrix<T>&, std::uint32_t, BlockCsr<1, double, Backend>&);

}  // namespace treacle
