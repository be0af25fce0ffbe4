#pragma once

#include "treacle/core/pseudo_random.hpp"
#include "treacle/linear/block_csr.hpp"
#include "treacle/search/buckets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace treacle::test {

/// Pressure equation of ISPH on a jittered column of particles of spacing 1 (cubic spline of h = 1.2,
/// support 2.4): p = 0 on the top and front layers, whose rows are empty; no walls. The particles are in the order
/// of their cells of edge 2.4, along a Morton curve.
struct PressureColumn {
  BlockCsr<1> a;
  std::vector<std::uint64_t> key;        // of each particle: its cell's place on the curve
  std::vector<std::uint32_t> latticeOf;  // of each particle: its number in the lattice
  std::vector<bool> unknown;             // of each particle

  explicit PressureColumn(Vec<3, int> latticeSize) : size_(latticeSize) {
    place();
    sort();
    assemble();
  }

  std::uint32_t count() const { return a.rows(); }
  BucketLevels<> levels() const {
    Context<Cpu> context;
    BucketLevels<> levels;
    findBuckets(context, key, 0, 3, levels);
    return levels;
  }
  /// Uniform in (-1, 1), the same whatever the order of the particles; zero where p is known.
  std::vector<double> rightHandSide() const {
    std::vector<double> b(count());
    for (std::uint32_t i = 0; i < count(); ++i) b[i] = unknown[i] ? pseudoRandom(latticeOf[i]) : 0;
    return b;
  }

 private:
  static constexpr double support = 2.4, h = support / 2, jitter = 0.15;

  std::size_t points() const { return std::size_t(size_[0]) * size_[1] * size_[2]; }
  Vec<3, int> latticeAt(std::uint32_t i) const {
    const auto n = static_cast<int>(i);
    return {n / (size_[1] * size_[2]), n / size_[2] % size_[1], n % size_[2]};
  }
  bool isSurface(std::uint32_t i) const {
    return latticeAt(i)[2] == size_[2] - 1 || latticeAt(i)[0] == size_[0] - 1;
  }

  void place() {
    for (std::uint32_t i = 0; i < points(); ++i) {
      Vec<3> x{};
      for (int k = 0; k < 3; ++k) x[k] = latticeAt(i)[k] + jitter * pseudoRandom(3 * i + k);
      position_.push_back(x);
    }
  }

  void sort() {
    Vec<3> low = Vec<3>::filled(INFINITY);
    for (std::uint32_t i = 0; i < points(); ++i)
      for (int k = 0; k < 3 && !isSurface(i); ++k) low[k] = std::min(low[k], position_[i][k]);
    std::vector<std::uint64_t> keys(points());
    for (std::uint32_t i = 0; i < points(); ++i)
      for (int k = 0; k < 3; ++k) {
        const auto cell = static_cast<std::uint64_t>(std::max(0.0, (position_[i][k] - low[k] + 1e-9) / support));
        for (int bit = 0; bit < 16; ++bit) keys[i] |= (cell >> bit & 1) << (3 * bit + k);
      }
    latticeOf.resize(points());
    std::iota(latticeOf.begin(), latticeOf.end(), 0u);
    std::stable_sort(latticeOf.begin(), latticeOf.end(), [&](auto i, auto j) { return keys[i] < keys[j]; });
    for (std::uint32_t i : latticeOf) {
      key.push_back(keys[i]);
      unknown.push_back(!isSurface(i));
    }
  }

  /// -2 W'(r) / r of the cubic spline: what two particles are coupled by.
  static double coupling(double r) {
    const double q = r / h;
    const double slope = q < 1 ? -3 * q + 2.25 * q * q : -0.75 * (2 - q) * (2 - q);
    return r > support ? 0 : -2 * slope / (M_PI * h * h * h * h) / r;
  }

  void assemble() {
    std::vector<std::uint32_t> placeOf(points()), column;
    for (std::uint32_t i = 0; i < points(); ++i) placeOf[latticeOf[i]] = i;
    std::vector<double> value;
    a.rowStart.resize(points() + 1);
    a.rowStart[0] = 0;
    for (std::uint32_t i = 0; i < points(); ++i) {
      std::vector<std::pair<std::uint32_t, double>> row;
      double diagonal = 0;
      forEachNear(latticeOf[i], [&](std::uint32_t j) {
        const Vec<3> d = position_[latticeOf[i]] - position_[j];
        const double c = coupling(std::sqrt(dot(d, d)));
        diagonal += c;
        if (c > 0 && !isSurface(j)) row.emplace_back(placeOf[j], -c);
      });
      row.emplace_back(i, diagonal);
      std::sort(row.begin(), row.end());
      for (std::size_t k = 0; k < row.size() && unknown[i]; ++k) {
        column.push_back(row[k].first);
        value.push_back(row[k].second);
      }
      a.rowStart[i + 1] = column.size();
    }
    a.column.resize(column.size());
    a.value.resize(column.size());
    std::copy(column.begin(), column.end(), a.column.begin());
    for (std::size_t k = 0; k < value.size(); ++k) a.value[k] = {{value[k]}};
  }

  /// f(j) for all lattice points that jitter may have brought into the support of i.
  template <class F>
  void forEachNear(std::uint32_t i, F&& f) const {
    const Vec<3, int> p = latticeAt(i);
    for (int x = std::max(0, p[0] - 2); x <= std::min(size_[0] - 1, p[0] + 2); ++x)
      for (int y = std::max(0, p[1] - 2); y <= std::min(size_[1] - 1, p[1] + 2); ++y)
        for (int z = std::max(0, p[2] - 2); z <= std::min(size_[2] - 1, p[2] + 2); ++z) {
          const auto j = static_cast<std::uint32_t>((x * size_[1] + y) * size_[2] + z);
          if (j != i) f(j);
        }
  }

  Vec<3, int> size_;
  std::vector<Vec<3>> position_;  // by lattice
};

}  // namespace treacle::test
