#include "treacle/core/each.hpp"
#include "treacle/isph/each_row.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace treacle {
namespace {

template <class T>
double sumOfRow(const IsphMatrix<T>& a, std::size_t row, const double* x) {
  double sum = 0;
  for (const std::size_t section : {row, a.rows + row})
    for (std::uint64_t k = a.start[section]; k < a.start[section + 1]; ++k)
      sum += a.coefficient[k] * x[a.column[k]];
  return sum;
}

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

template <class Staged, class T, class Store>
void forEachSum(Context<Cpu>&, const IsphMatrix<T>& a, const double* x, const Store& store) {
  parallelFor(a.rows, parallelGrain,
              [=](std::size_t row) { store(static_cast<std::uint32_t>(row), sumOfRow(a, row, x)); });
}

template <class T, class Backend>
void nearResidual(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
                  std::span<T> res) {
  parallelFor(a.rows, parallelGrain,
              [&](std::size_t i) { res[i] = a.inverseNear[i] > 0 ? nearRest(a, i, r[i], x.data()) : T(0); });
}

template <class T, class Backend>
void lastSweep(Context<Backend>&, const IsphMatrix<T>& a, std::span<const double> r, std::span<const T> x,
               std::span<double> z) {
  parallelFor(a.rows, parallelGrain, [&](std::size_t i) {
    const T inverse = a.inverseNear[i];
    z[i] = inverse > 0 ? x[i] + inverse * nearRest(a, i, r[i], x.data()) : T(0);
  });
}

template <class T, class Backend>
void compressed(Context<Backend>&, const IsphMatrix<T>& a, std::uint32_t rows,
                BlockCsr<1, double, Backend>& result) {
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

TREACLE_EACH_ROW(double, Cpu)
TREACLE_EACH_ROW(float, Cpu)

}  // namespace treacle
