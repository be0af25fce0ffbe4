#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// A matrix on a device while it is inverted, of n unknowns in panels of 32; the memory is the backend's.
template <class T>
struct DenseTask {
  std::uint32_t unknowns, panels;
  double *dense, *b, *w;
  T* inverse;
};

/// Inverses of small symmetric positive definite matrices of n = B a.rows() unknowns, block after block: n x n
/// numbers, row-major, exactly symmetric. The lower triangles are read. Computed in double precision with an
/// addition to the diagonal (regularisation), which makes semidefinite matrices invertible; unknowns where a pivot
/// still is not positive get zeros. A device, which waits for one pivot after the other, inverts two matrices in
/// the time of one.
template <class T, class Backend = Cpu>
class DenseInverses;

template <class T>
class DenseInverses<T, Cpu> {
 public:
  template <int B>
  void add(Context<Cpu>&, const BlockCsr<B>& a, std::span<T> inverse);
  void finish(Context<Cpu>&) {}
};

template <class T>
class DenseInverses<T, Cuda> {
 public:
  static constexpr std::size_t most = 2;

  /// `inverse` is there after finish(). Errors: std::bad_alloc; std::length_error beyond `most`.
  template <int B>
  void add(Context<Cuda>&, const BlockCsr<B, double, Cuda>& a, std::span<T> inverse);
  void finish(Context<Cuda>&);

 private:
  std::vector<DenseTask<T>> tasks_;
  std::vector<Buffer<double, Cuda>> memory_;
};

/// Of one matrix.
template <class T, int B, class Backend>
void denseInverse(Context<Backend>& context, const BlockCsr<B, double, Backend>& a, std::span<T> inverse) {
  DenseInverses<T, Backend> inverses;
  inverses.add(context, a, inverse);
  inverses.finish(context);
}

/// What is added to a diagonal element. Coarse operators of bodies with rough edges are singular, and there the
/// inverse becomes 1 / relative; rounded to T, its errors must stay small beside the inverse of everything else.
template <class T>
TREACLE_HD constexpr double regularisation(double diagonal, double largest) {
  constexpr double relative = sizeof(T) == sizeof(double) ? 1e-10 : 1e-5;
  return relative * (diagonal > 1e-6 * largest ? diagonal : 1e-6 * largest);
}

}  // namespace treacle
