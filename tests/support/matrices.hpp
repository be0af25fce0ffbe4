#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/linear/block_csr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace treacle::test {

/// Random blocks at the columns within `reach` of the diagonal, some of them left out so that rows differ in
/// length.
template <int D, class T = double>
BlockCsr<D, T> randomMatrix(std::uint32_t rows, std::uint32_t reach, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<T> normal;
  std::bernoulli_distribution present(0.8);
  std::vector<std::uint32_t> column;
  BlockCsr<D, T> a;
  a.rowStart.resize(std::size_t{rows} + 1);
  a.rowStart[0] = 0;
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = i < reach ? 0 : i - reach; j <= i + reach && j < rows; ++j)
      if (j == i || present(random)) column.push_back(j);
    a.rowStart[i + 1] = column.size();
  }
  a.column.resize(column.size());
  a.value.resize(column.size());
  std::copy(column.begin(), column.end(), a.column.begin());
  for (Block<D, T>& block : a.value)
    for (T& value : block.a) value = normal(random);
  return a;
}

/// Groups of one to four rows: the first member of each, and the end.
inline std::vector<std::uint32_t> randomMembers(std::uint32_t rows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint32_t> size(1, 4);
  std::vector<std::uint32_t> begin;
  for (std::uint32_t i = 0; i < rows; i += size(random)) begin.push_back(i);
  begin.push_back(rows);
  return begin;
}

template <int D, class T>
BlockCsr<D, T, Cuda> onDevice(const Context<Cuda>& context, const BlockCsr<D, T>& a) {
  BlockCsr<D, T, Cuda> copy;
  copyToDevice<std::uint64_t>(context, a.rowStart, copy.rowStart);
  copyToDevice<std::uint32_t>(context, a.column, copy.column);
  copyToDevice<Block<D, T>>(context, a.value, copy.value);
  return copy;
}

template <int D, class T>
BlockCsr<D, T> onHost(const Context<Cuda>& context, const BlockCsr<D, T, Cuda>& a) {
  BlockCsr<D, T> copy;
  copyToHost<std::uint64_t>(context, a.rowStart, copy.rowStart);
  copyToHost<std::uint32_t>(context, a.column, copy.column);
  copyToHost<Block<D, T>>(context, a.value, copy.value);
  return copy;
}

/// |a - b| / |b| over all numbers.
template <class T>
double relativeDifference(std::span<const T> a, std::span<const T> b) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    difference += std::pow(double(a[i]) - double(b[i]), 2);
    norm += std::pow(double(b[i]), 2);
  }
  return norm > 0 ? std::sqrt(difference / norm) : std::sqrt(difference);
}
/// The same for vectors and blocks.
template <class T, class V>
double relativeDifference(const V& a, const V& b) {
  constexpr std::size_t numbers = sizeof(*a.begin()) / sizeof(T);
  return relativeDifference<T>({reinterpret_cast<const T*>(a.data()), numbers * a.size()},
                               {reinterpret_cast<const T*>(b.data()), numbers * b.size()});
}

/// The same for matrices, whatever the order of the columns; infinite where `a` has blocks that `b` has not, or
/// one twice. Blocks that `a` has not count as zero.
template <int D, class T>
double valueDifference(const BlockCsr<D, T>& a, const BlockCsr<D, T>& b) {
  constexpr double differs = std::numeric_limits<double>::infinity();
  if (a.rows() != b.rows()) return differs;
  double difference = 0, norm = 0;
  for (std::uint32_t i = 0; i < b.rows(); ++i) {
    std::map<std::uint32_t, const Block<D, T>*> row;
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k) row[a.column[k]] = &a.value[k];
    if (row.size() != a.rowStart[i + 1] - a.rowStart[i]) return differs;
    std::size_t found = 0;
    for (std::uint64_t k = b.rowStart[i]; k < b.rowStart[i + 1]; ++k) {
      const auto mine = row.find(b.column[k]);
      if (mine != row.end()) ++found;
      for (int e = 0; e < D * D; ++e) {
        const double value = mine == row.end() ? 0 : double(mine->second->a[e]);
        difference += std::pow(value - double(b.value[k].a[e]), 2);
        norm += std::pow(double(b.value[k].a[e]), 2);
      }
    }
    if (found != row.size()) return differs;
  }
  return norm > 0 ? std::sqrt(difference / norm) : std::sqrt(difference);
}
/// The same, but infinite where the patterns differ at all.
template <int D, class T>
double matrixDifference(const BlockCsr<D, T>& a, const BlockCsr<D, T>& b) {
  if (!std::equal(a.rowStart.begin(), a.rowStart.end(), b.rowStart.begin(), b.rowStart.end()))
    return std::numeric_limits<double>::infinity();
  return valueDifference(a, b);
}

}  // namespace treacle::test
