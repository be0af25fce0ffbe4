#pragma once

#include "treacle/core/block.hpp"
#ifndef __CUDACC__
#include "treacle/core/lanes.hpp"
#endif

namespace treacle {

/// Sum of block-vector products along a matrix row. Products are collected element by element and added up once at
/// the end, so that no addition waits for the one before. Host only.
template <int D, class T>
class RowSum {
 public:
  void add(const Block<D, T>& m, const Vec<D, T>& x) {
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) part_(r, c) += m(r, c) * x[c];
  }
  Vec<D, T> total() const {
    Vec<D, T> y{};
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) y[r] += part_(r, c);
    return y;
  }

 private:
  Block<D, T> part_{};
};

#ifndef __CUDACC__  // whose front end knows no vectors of dependent size, and which compiles no host loop
/// In two dimensions a block fills one vector register.
template <class T>
class RowSum<2, T> {
 public:
  void add(const Block<2, T>& m, const Vec<2, T>& x) {
    part_ += load<Four>(m.a) * generate<Four>([&](auto k) { return x[k % 2]; });
  }
  Vec<2, T> total() const { return {part_[0] + part_[1], part_[2] + part_[3]}; }

 private:
  using Four = Simd<T, 4>;
  Four part_ = {};
};
#endif

}  // namespace treacle
