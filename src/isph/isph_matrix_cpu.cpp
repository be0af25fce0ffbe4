#include "treacle/isph/isph_matrix.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// r - A x of a row with the smoothers' matrix.
template <class T>
T nearRest(const IsphMatrix<T>& a, std::size_t row, double r, const T* x) {
  const T unit = static_cast<T>(a.unit), inverseUnit = 1 / unit;
  T sum = 0;
  for (std::uint64_t k = a.start[row]; k < a.start[row + 1]; ++k)
    sum += static_cast<T>(static_cast<int>(a.coefficient[k] * inverseUnit + T(0.5))) * x[a.column[k]];
  return static_cast<T>(r) - x[row] / a.inverseNear[row] + unit * sum;
}

}  // namespace

template <class T>
void multiply(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> x, std::span<double> y) {
  parallelFor(a.rows, parallelGrain, [&](std::size_t i) {
    double sum = 0;
    for (const std::size_t section : {i, a.rows + i})
      for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
        sum += a.coefficient[k] * x[a.column[k]];
    y[i] = a.diagonal[i] * x[i] - sum;
  });
}

template <class T>
void firstSweep(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<T> x) {
  parallelFor(a.rows, parallelGrain, [&](std::size_t i) { x[i] = a.inverseNear[i] * static_cast<T>(r[i]); });
}

template <class T>
void nearResidual(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res) {
  parallelFor(a.rows, parallelGrain,
              [&](std::size_t i) { res[i] = a.inverseNear[i] > 0 ? nearRest(a, i, r[i], x.data()) : T(0); });
}

template <class T>
void lastSweep(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z) {
  parallelFor(a.rows, parallelGrain, [&](std::size_t i) {
    const T inverse = a.inverseNear[i];
    z[i] = inverse > 0 ? x[i] + inverse * nearRest(a, i, r[i], x.data()) : T(0);
  });
}

template <class T>
void jacobi(Context<Cpu>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<double> z) {
  parallelFor(a.rows, parallelGrain, [&](std::size_t i) { z[i] = a.diagonal[i] > 0 ? r[i] / a.diagonal[i] : 0; });
}

template <class T>
void compressed(Context<Cpu>&, const IsphMatrix<T>& a, std::uint32_t rows, BlockCsr<1>& result) {
  result.rowStart.resize(std::size_t{rows} + 1);
  result.rowStart[0] = 0;
  std::vector<std::pair<std::uint32_t, double>> entries;
  const auto takeRow = [&](std::size_t i) {
    entries.clear();
    if (i >= a.rows || !(a.diagonal[i] > 0)) return;
    entries.emplace_back(static_cast<std::uint32_t>(i), a.diagonal[i]);
    for (const std::size_t section : {i, a.rows + i})
      for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
        if (a.coefficient[k] > 0) entries.emplace_back(a.column[k], -static_cast<double>(a.coefficient[k]));
  };
  for (std::size_t i = 0; i < rows; ++i) {
    takeRow(i);
    result.rowStart[i + 1] = result.rowStart[i] + entries.size();
  }
  result.column.resize(result.rowStart[rows]);
  result.value.resize(result.rowStart[rows]);
  for (std::size_t i = 0; i < a.rows; ++i) {
    takeRow(i);
    std::sort(entries.begin(), entries.end());
    std::uint64_t place = result.rowStart[i];
    for (const auto& [j, value] : entries) {
      result.column[place] = j;
      result.value[place++].a[0] = value;
    }
  }
}

#define TREACLE_INSTANTIATE(T)                                                                                    \
  template void multiply<T>(Context<Cpu>&, const IsphMatrix<T>&, std::span<const double>, std::span<double>);     \
  template void firstSweep<T>(Context<Cpu>&, const IsphMatrix<T>&, std::span<const double>, std::span<T>);        \
  template void nearResidual<T>(Context<Cpu>&, const IsphMatrix<T>&, std::span<const double>, std::span<const T>, \
                                std::span<T>);                                                                    \
  template void lastSweep<T>(Context<Cpu>&, const IsphMatrix<T>&, std::span<const double>, std::span<const T>,    \
                             std::span<double>);                                                                  \
  template void jacobi<T>(Context<Cpu>&, const IsphMatrix<T>&, std::span<const double>, std::span<double>);       \
  template void compressed<T>(Context<Cpu>&, const IsphMatrix<T>&, std::uint32_t, BlockCsr<1>&);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
